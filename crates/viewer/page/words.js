// All that the page says, in English and German: one table. `{x}` is put in; `[[text|term]]` is explained by the glossary.

const TABLE = {
  // The frame of the page.
  device: ["Show me", "Zeige"],
  tour: ["Tour", "Rundgang"],
  gallery: ["All devices", "Alle Geräte"],
  back: ["Back", "Zurück"],
  next: ["Next", "Weiter"],
  close: ["Close", "Schließen"],
  retry: ["Connect again", "Neu verbinden"],
  view: ["View", "Ansicht"],
  picture: ["The rendered view", "Das berechnete Bild"],
  help: ["Arrow keys orbit the camera, plus and minus zoom, Home resets it. Enter lets the arrow keys choose the point whose ray is drawn.",
    "Pfeiltasten drehen die Kamera, Plus und Minus holen heran, Pos 1 setzt sie zurück. Nach der Eingabetaste wählen die Pfeiltasten den Punkt, dessen Strahl gezeichnet wird."],
  divider: ["Divider of the split view", "Teiler der geteilten Ansicht"],
  drop: ["Drop the photograph", "Foto hier ablegen"],
  rendering: ["Rendering", "Wird berechnet"],
  turn: ["Turn", "Drehen"],
  stop: ["Stop", "Halt"],
  rotation: ["Rotation", "Drehung"],
  "rotation.exactly": ["Rotation in degrees", "Drehung in Grad"],
  "rotation.says": ["{r} degrees", "{r} Grad"],
  show: ["Show", "Zeige"],
  "show.cloak": ["Cloak", "Tarnung"],
  "show.bare": ["Bare metal", "Nur Metall"],
  "show.mirror": ["Mirror", "Spiegel"],
  "show.empty": ["Nothing", "Nichts"],
  split: ["Split with", "Teilen mit"],
  "beside.nothing": ["nothing", "nichts"],
  "beside.bare": ["bare metal", "nur Metall"],
  "beside.empty": ["empty view", "leere Ansicht"],
  "beside.mirror": ["what it should look like", "wie es aussehen soll"],
  "side.cloak": ["cloak", "Tarnung"],
  "side.bare": ["bare metal", "nur Metall"],
  "side.mirror": ["mirror", "Spiegel"],
  "side.empty": ["nothing", "nichts"],
  "side.scene": ["the scene", "die Szene"],
  "side.says": ["{p} % {left}, the rest {right}", "{p} % {left}, der Rest {right}"],
  polarizer: ["Polarizer", "Polfilter"],
  "polarizer.none": ["none", "keiner"],
  "polarizer.horizontal": ["horizontal", "waagerecht"],
  "polarizer.vertical": ["vertical", "senkrecht"],
  "polarizer.angle": ["at an angle", "schräg"],
  angle: ["Angle (°)", "Winkel (°)"],
  flight: ["Light in flight", "Licht unterwegs"],
  "flight.title": ["The photograph flashes: what arrives at one moment, by the time that a pulse takes.",
    "Das Foto blitzt auf: was in einem Augenblick ankommt, nach der Zeit, die ein Lichtpuls braucht."],
  moment: ["Time after the flash", "Zeit nach dem Blitz"],
  fullscreen: ["Full screen", "Vollbild"],
  "photograph.choose": ["Photograph …", "Foto …"],
  "save.picture": ["Save picture", "Bild speichern"],
  "save.scene": ["Save scene", "Szene speichern"],
  "save.film": ["Film", "Film"],
  "save.film.title": ["One turn of the device as a film (WebM)", "Eine Umdrehung des Geräts als Film (WebM)"],
  "save.gif": ["GIF", "GIF"],
  "save.gif.title": ["One turn of the device as a GIF, for slides and messages: smaller and with fewer colors than the film",
    "Eine Umdrehung des Geräts als GIF, für Folien und Nachrichten: kleiner und mit weniger Farben als der Film"],
  "copy.link": ["Copy link", "Link kopieren"],
  "copy.embed": ["Embed", "Einbetten"],
  "copy.embed.title": ["Copy HTML that shows this view with one slider in a page of your own", "HTML kopieren, das diese Ansicht mit einem Regler in einer eigenen Seite zeigt"],
  "reset.camera": ["Reset camera", "Kamera zurück"],
  share: ["Keep and share", "Behalten und teilen"],
  section: ["Cross-section", "Schnitt von der Seite"],
  "section.says": ["Cross-section of the scene", "Schnitt durch die Szene"],
  "section.pixel": ["Cross-section of the scene with the light of pixel {x}, {y}", "Schnitt durch die Szene mit dem Licht des Bildpunkts {x}, {y}"],
  whole: ["whole scene", "ganze Szene"],
  point: ["Point at the picture to follow the light of that point.", "Auf das Bild zeigen, um dem Licht dieses Punkts zu folgen."],
  "legend.camera": ["camera", "Kamera"],
  "legend.ray": ["light", "Licht"],
  "legend.photo": ["photograph", "Foto"],
  "legend.metal": ["metal", "Metall"],
  "legend.index": ["[[index|index]]", "[[Brechzahl|index]]"],
  "legend.graded": ["graded", "mit Verlauf"],
  numbers: ["In numbers", "In Zahlen"],
  expert: ["More numbers", "Weitere Zahlen"],
  "numbers.says": ["Numbers for this view", "Zahlen zu dieser Ansicht"],
  parameters: ["Parameters", "Einstellungen"],
  of: ["of", "von"],
  place: ["Place and material", "Lage und Material"],
  "light.fold": ["Light and photograph", "Licht und Foto"],
  light: ["Light", "Licht"],
  "light.title": ["What makes the colors: daylight where a material has a law, or a lamp, or light of one wavelength.",
    "Was die Farben macht: Tageslicht, wo ein Material ein Gesetz hat, oder eine Lampe, oder Licht einer Wellenlänge."],
  "light.auto": ["as the materials need", "wie die Materialien es brauchen"],
  "light.rgb": ["all colors alike", "alle Farben gleich"],
  "light.D65": ["daylight", "Tageslicht"],
  "light.lamp": ["tungsten lamp", "Glühlampe"],
  "light.E": ["equal power", "gleiche Leistung"],
  "light.wavelength": ["one wavelength", "eine Wellenlänge"],
  written: ["as written", "wie geschrieben"],
  wavelength: ["Wavelength", "Wellenlänge"],
  bandwidth: ["Bandwidth (nm)", "Bandbreite (nm)"],
  "bandwidth.title": ["Full width of the light's line: leaves whose paths differ little are added as fields. 0 is light of one wavelength.",
    "Volle Breite der Linie: Wege, die sich wenig unterscheiden, werden als Felder addiert. 0 ist Licht einer Wellenlänge."],
  none: ["none", "keine"],
  map: ["Picture", "Bild"],
  border: ["Beyond the photograph", "Jenseits des Fotos"],
  "border.none": ["nothing", "nichts"],
  "border.mirror": ["mirrored", "gespiegelt"],
  "border.repeat": ["repeated", "wiederholt"],
  "border.clamp": ["its edge goes on", "sein Rand"],
  quality: ["Quality", "Güte"],
  "quality.width": ["Width in pixels", "Breite in Bildpunkten"],
  "quality.samples": ["Samples a pixel, finished", "Strahlen je Bildpunkt, fertig"],
  "quality.power": ["Follow [[branches|branch]] above", "[[Zweigen|branch]] folgen über"],
  "quality.rays": ["Rays", "Strahlen"],
  "quality.shared": ["share what neighbours know", "teilen, was Nachbarn wissen"],
  "quality.exact": ["are traced one by one", "werden einzeln verfolgt"],
  keys: ["Keys", "Tasten"],
  "keys.space": ["turn the device, or stop", "Gerät drehen, oder anhalten"],
  "keys.by": ["rotate by 1°, with Shift by 10°", "um 1° drehen, mit Umschalt um 10°"],
  "keys.show": ["cloak, bare metal, mirror", "Tarnung, nur Metall, Spiegel"],
  "keys.split": ["split view on and off", "geteilte Ansicht an und aus"],
  "keys.full": ["full screen", "Vollbild"],
  "keys.picture": ["On the picture:", "Auf dem Bild:"],
  "keys.orbit": ["orbit the camera", "Kamera bewegen"],
  "keys.zoom": ["zoom", "heranholen"],
  "keys.home": ["reset the camera", "Kamera zurücksetzen"],
  "keys.enter": ["let the arrow keys choose the point to follow", "Pfeiltasten wählen den Punkt, dem gefolgt wird"],
  "keys.escape": ["follow no point", "keinem Punkt folgen"],
  whole_page: ["Open the whole page", "Ganze Seite öffnen"],
  noscript: ["This page needs JavaScript, which it brings along.", "Diese Seite braucht JavaScript; sie bringt es mit."],

  // What is said now and then.
  preview: ["Preview: {w} × {h}", "Vorschau: {w} × {h}"],
  state: ["{w} × {h}, {n} of {all} samples a pixel", "{w} × {h}, {n} von {all} Strahlen je Bildpunkt"],
  done: ["{w} × {h}, {n} samples a pixel", "{w} × {h}, {n} Strahlen je Bildpunkt"],
  finished: ["Finished: {n} samples a pixel", "Fertig: {n} Strahlen je Bildpunkt"],
  damaged: ["This link is damaged: it holds no scene. Here is the one that was opened.", "Dieser Link ist beschädigt: Er enthält keine Szene. Hier ist die, die geöffnet war."],
  hangs: ["The photograph {name} hangs behind the device", "Das Foto {name} hängt hinter dem Gerät"],
  too_large: ["a photograph may have {n} MiB", "ein Foto darf {n} MiB haben"],
  copied: ["The link is copied: it shows this view on any machine that reaches this page.", "Der Link ist kopiert: Er zeigt diese Ansicht überall, wo man diese Seite erreicht."],
  "copied.here": ["The link is copied. It leads to this server, which ends with the program, and holds its secret.",
    "Der Link ist kopiert. Er führt zu diesem Server, der mit dem Programm endet, und enthält sein Geheimnis."],
  "copied.photograph": [" Your photograph is not in it.", " Dein Foto ist nicht darin."],
  "copied.not": ["The link is in the address bar.", "Der Link steht in der Adresszeile."],
  embedded: ["The HTML is copied.", "Das HTML ist kopiert."],
  filming: ["Filming: {p} %", "Film: {p} %"],
  filmed: ["The film is saved.", "Der Film ist gespeichert."],
  "filmed.not": ["This browser cannot record films, but it can make a GIF.", "Dieser Browser kann keine Filme aufnehmen, aber ein GIF machen."],
  "fault.english": ["", "Diese Szene lässt sich so nicht zeigen; das Programm sagt auf Englisch, warum: "],
  choosing: ["Arrow keys move the point to follow", "Pfeiltasten bewegen den Punkt, dem gefolgt wird"],
  orbiting: ["Arrow keys orbit the camera", "Pfeiltasten drehen die Kamera"],
  "lost.server": ["The server has ended, or cannot be reached.", "Der Server ist beendet oder nicht erreichbar."],
  "refused.server": ["No connection: too many pages may be open already, or the server has ended.", "Keine Verbindung: Vielleicht sind zu viele Seiten offen, oder der Server ist beendet."],
  "lost.worker": ["The computation has ended: a mistake in the program, or no memory left.", "Die Rechnung ist beendet: ein Fehler im Programm, oder kein Speicher mehr."],
  "refused.worker": ["The computation cannot begin: this browser may be too old, or a file is missing.", "Die Rechnung kann nicht beginnen: Der Browser ist vielleicht zu alt, oder eine Datei fehlt."],
  "ray.power": ["Pixel {x}, {y}: {d} of the light comes from the photograph, {e} from the surroundings, {a} is absorbed, {p} not followed.",
    "Bildpunkt {x}, {y}: {d} des Lichts kommt vom Foto, {e} aus der Umgebung, {a} wird verschluckt, {p} nicht verfolgt."],
  "ray.one": ["1 [[branch|branch]] leaves: {s}.", "1 [[Zweig|branch]] tritt aus: {s}."],
  "ray.branches": ["{n} [[branches|branch]] leave, the strongest: {s}.", "{n} [[Zweige|branch]] treten aus, die stärksten: {s}."],
  "ray.delay": ["Against the empty view it is late by {t}.", "Gegen die leere Ansicht kommt es um {t} später."],
  "ray.early": ["Against the empty view it is early by {t}.", "Gegen die leere Ansicht kommt es um {t} früher."],
  "ray.same": ["It comes at the same time as in the empty view.", "Es kommt zur selben Zeit wie in der leeren Ansicht."],
  corner: ["Corner at {x}, {y} cm", "Ecke bei {x}, {y} cm"],
  removed: ["Remove layer {n}", "Schicht {n} entfernen"],
  added: ["Add a layer", "Schicht hinzufügen"],
  exactly: ["{name}, exactly", "{name}, genau"],
  red: ["red", "rot"],
  green: ["green", "grün"],
  blue: ["blue", "blau"],

  // Keys of devices; English says their own names.
  "key.material": ["material", "Material"],
  "key.side": ["side", "Kantenlänge"],
  "key.kappa": ["kappa", "Kappa"],
  "key.rounded": ["rounded", "gerundete Werte"],
  "key.width": ["width", "Breite"],
  "key.height": ["height", "Höhe"],
  "key.fresnel": ["fresnel", "Fresnel-Spiegelung"],
  "key.referenced": ["referenced", "auf 1 bezogen"],
  "key.inner": ["inner", "innen"],
  "key.outer": ["outer", "außen"],
  "key.radius": ["radius", "Radius"],
  "key.floor": ["floor", "Boden"],
  "key.period": ["period", "Periode"],
  "key.angle": ["angle", "Winkel"],
  "key.core": ["core", "Kern"],
  "key.length": ["length", "Länge"],
  "key.position": ["position", "Ort"],
  "key.axis": ["axis", "Achse"],
  "key.metal": ["metal", "Metall"],
  "key.coating": ["coating", "Beschichtung"],
  "key.dispersion": ["dispersion", "Dispersion"],
  "key.imperfection": ["imperfection", "Fehler"],
  "key.index": ["index", "Brechzahl"],
  "key.permittivity": ["permittivity", "Permittivität"],
  "key.permeability": ["permeability", "Permeabilität"],
  "key.shape": ["shape", "Form"],
  "key.size": ["size", "Größe"],
  "key.surface": ["surface", "Oberfläche"],
  "key.color": ["color", "Farbe"],
  "key.thickness": ["thickness", "Dicke"],
  "key.thickness_nm": ["thickness nm", "Dicke nm"],
  "key.diameter": ["diameter", "Durchmesser"],
  "key.priority": ["priority", "Vorrang"],
  "key.error": ["error", "Zufallsfehler"],
  "key.levels": ["levels", "Stufen"],
  "key.minimum": ["minimum", "Kleinstwert"],
  "key.maximum": ["maximum", "Größtwert"],
  "key.loss_tangent": ["loss tangent", "Verlustfaktor"],
  "key.correlation": ["correlation", "Korrelationslänge"],
  "key.gradient": ["gradient", "Gefälle"],
  "key.scale": ["scale", "Maßstab"],

  // Numbers.
  "n.place": ["Light that arrives where it should", "Licht, das ankommt, wo es soll"],
  "n.bare": ["… with the bare metal instead", "… mit dem nackten Metall"],
  "n.late": ["Delay, on average", "Verspätung, im Mittel"],
  "n.delivered": ["From the photograph", "Vom Foto"],
  "n.escaped": ["From the surroundings", "Aus der Umgebung"],
  "n.absorbed": ["Absorbed", "Verschluckt"],
  "n.pruned": ["In branches not followed", "In Zweigen, denen nicht gefolgt wird"],
  "n.most": ["Largest delay", "Größte Verspätung"],
  "n.misses": ["Light misses its place by, rms", "Licht verfehlt seinen Ort um (quadr. Mittel)"],
  "n.ideal": ["[[Likeness|likeness]] to what it should look like", "[[Ähnlichkeit|likeness]] mit dem Sollbild"],
  "n.empty": ["Likeness to the empty view", "Ähnlichkeit mit der leeren Ansicht"],
  "n.bare.empty": ["Bare metal’s likeness to the empty view", "Ähnlichkeit des Metalls mit der leeren Ansicht"],
  "n.note": ["Means over the pixels that meet a device ({s} of {w} × {h}). A turned cloak should look like a mirror and not like nothing: so its likeness to the empty view may be less than that of bare metal, which shades the same pixels evenly. What counts is the first number.",
    "Mittel über die Bildpunkte, die ein Gerät treffen ({s} von {w} × {h}). Eine gedrehte Tarnung soll wie ein Spiegel aussehen und nicht wie nichts: Daher kann sie der leeren Ansicht weniger gleichen als nacktes Metall, das dieselben Bildpunkte gleichmäßig verdunkelt. Es zählt die erste Zahl."],
  "n.old": ["Of the view before; those of this one come when it rests.", "Von der Ansicht zuvor; die von dieser kommen, wenn sie ruht."],

  // Maps.
  "map.none": ["as seen", "wie gesehen"],
  "map.time_of_flight": ["time of flight", "Laufzeit"],
  "map.time_of_flight_spread": ["spread of times of flight", "Streuung der Laufzeiten"],
  "map.time_of_flight_difference": ["time of flight against empty", "Laufzeit gegen leer"],
  "map.group_delay": ["delay of a pulse", "Laufzeit eines Pulses"],
  "map.group_delay_spread": ["spread of pulses", "Streuung der Pulse"],
  "map.group_delay_difference": ["delay of a pulse against empty", "Laufzeit eines Pulses gegen leer"],
  "map.delivered": ["power from the photograph", "Leistung vom Foto"],
  "map.escaped": ["power from the surroundings", "Leistung aus der Umgebung"],
  "map.absorbed": ["power absorbed", "verschluckte Leistung"],
  "map.pruned": ["power not followed", "nicht verfolgte Leistung"],
  "map.extraordinary_share": ["share in the extraordinary wave", "Anteil der außerordentlichen Welle"],
  "map.first_face_reflectance": ["reflected at the first face", "an der ersten Fläche gespiegelt"],
  same: ["everywhere the same", "überall gleich"],

  // The menu.
  opened: ["The scene that was opened", "Die geöffnete Szene"],
  "group.cloaks": ["Cloaks: light goes around metal", "Tarnungen: Licht geht um Metall herum"],
  "group.carpets": ["Carpets: a bump looks flat", "Teppiche: eine Beule sieht flach aus"],
  "group.balls": ["Balls that bend light", "Kugeln, die Licht biegen"],
  "group.things": ["Lenses, mirrors, glass, water", "Linsen, Spiegel, Glas, Wasser"],
  "group.own": ["To start from with your own", "Zum Anfangen mit Eigenem"],
  "group.more": ["More", "Weitere"],
  "name.square-cloak": ["Perfect cloak, from one side (iii)", "Perfekte Tarnung, von einer Seite (iii)"],
  "name.sphere-cloak": ["Perfect cloak, from everywhere: ball", "Perfekte Tarnung, von überall: Kugel"],
  "name.cylinder-cloak": ["Perfect cloak, from everywhere: rod", "Perfekte Tarnung, von überall: Stab"],
  "name.double-gaussian-cloak": ["Cloak of graded glass (iv)", "Tarnung aus Glas mit Verlauf (iv)"],
  "name.square-cloak-positive-uniaxial": ["Cloak for one polarization, first kind (i)", "Tarnung für eine Polarisation, erste Art (i)"],
  "name.square-cloak-negative-uniaxial": ["Cloak for one polarization, second kind (ii)", "Tarnung für eine Polarisation, zweite Art (ii)"],
  "name.open-core": ["A ball hidden inside a cloak", "Eine Kugel, in der Tarnung versteckt"],
  "name.crossed-cloaks": ["Two cloaks crosswise", "Zwei Tarnungen über Kreuz"],
  "name.standing-cylinder-cloak": ["Cloak around an upright rod", "Tarnung um einen stehenden Stab"],
  "name.cylinder-cloak-radial": ["Rod cloak of crystal, spokes", "Stab-Tarnung aus Kristall, wie Speichen"],
  "name.cylinder-cloak-azimuthal": ["Rod cloak of crystal, rings", "Stab-Tarnung aus Kristall, wie Ringe"],
  "name.mirror-detour-orthographic": ["Eight mirrors, seen along parallel rays", "Acht Spiegel, entlang paralleler Strahlen"],
  "name.mirror-detour-perspective": ["Eight mirrors, seen by an eye", "Acht Spiegel, mit dem Auge gesehen"],
  "name.gaussian-carpet": ["Carpet, exact map", "Teppich, genaue Abbildung"],
  "name.quasi-conformal-carpet": ["Carpet of Li and Pendry", "Teppich von Li und Pendry"],
  "name.grating-carpet": ["Carpet over a grating", "Teppich über einem Gitter"],
  "name.carpet-in-glass": ["Carpet in a block of glass", "Teppich in einem Glasblock"],
  "name.prisms-on-floor": ["Carpet of two prisms", "Teppich aus zwei Prismen"],
  "name.invisible-sphere": ["Invisible ball", "Unsichtbare Kugel"],
  "name.invisible-sphere-regularized": ["Invisible ball of crystal", "Unsichtbare Kugel aus Kristall"],
  "name.bending-sphere": ["Ball that turns light by 90°", "Kugel, die Licht um 90° dreht"],
  "name.eaton-lens": ["Ball that sends light back (Eaton)", "Kugel, die Licht zurückschickt (Eaton)"],
  "name.luneburg-lens": ["Luneburg lens", "Luneburg-Linse"],
  "name.fisheye-lens": ["Maxwell’s fish-eye", "Maxwells Fischauge"],
  "name.fisheye-hemisphere": ["Half a fish-eye", "Halbes Fischauge"],
  "name.rod-in-water": ["Rod in a glass of water", "Stab im Wasserglas"],
  "name.rod-in-negative-water": ["Rod in water of negative index", "Stab in Wasser mit negativer Brechzahl"],
  "name.rod-in-matched-negative-water": ["Rod in perfect negative water", "Stab in perfektem negativem Wasser"],
  "name.bodies": ["Balls of glass and of negative index", "Kugeln aus Glas und mit negativer Brechzahl"],
  "name.lens": ["Three lenses", "Drei Linsen"],
  "name.polyhedron": ["Diamond, octahedron, wedge", "Diamant, Oktaeder, Keil"],
  "name.mirror": ["Periscope, gold and a mirror box", "Periskop, Gold und ein Spiegelkasten"],
  "name.tilted-box": ["Tilted box of glass", "Schräger Glasquader"],
  "name.coated-panes": ["Coated panes", "Beschichtete Scheiben"],
  "name.quartz-wedge": ["Quartz between crossed polarizers", "Quarz zwischen gekreuzten Polfiltern"],
  "name.graded-box": ["Mirage: a graded box", "Luftspiegelung: Quader mit Verlauf"],
  "name.prisms": ["Your own prisms", "Eigene Prismen"],
  "name.graded": ["Your own graded rod", "Eigener Stab mit Verlauf"],
  "name.graded-3d": ["Your own graded ball", "Eigene Kugel mit Verlauf"],

  // Captions: what stands there.
  "photo.person": ["the person", "der Person"],
  "photo.own": ["your photograph", "deinem Foto"],
  "photo.other": ["the photograph", "dem Foto"],
  "thing.square-cloak": ["A metal bar {h} cm high", "Ein {h} cm hoher Metallstab"],
  "thing.double-gaussian-cloak": ["A metal lens {h} cm high", "Eine {h} cm hohe Metalllinse"],
  "thing.cylinder-cloak": ["A metal rod {h} cm thick", "Ein {h} cm dicker Metallstab"],
  "thing.sphere-cloak": ["A metal ball {h} cm across", "Eine {h} cm große Metallkugel"],
  "thing.mirror-detour": ["A detour of eight mirrors", "Ein Umweg aus acht Spiegeln"],
  "thing.carpet": ["A bump {h} cm high on a mirror floor", "Eine {h} cm hohe Beule auf einem Spiegelboden"],
  "thing.prisms": ["A device of prisms", "Ein Gerät aus Prismen"],
  "thing.prisms-floor": ["A bump under prisms on a mirror floor", "Eine Beule unter Prismen auf einem Spiegelboden"],
  "thing.invisible-sphere": ["A ball {h} cm across of [[graded|graded]] glass", "Eine {h} cm große Kugel aus Glas mit [[Verlauf|graded]]"],
  "thing.ball": ["A ball {h} cm across of [[graded|graded]] glass", "Eine {h} cm große Kugel aus Glas mit [[Verlauf|graded]]"],
  "thing.lens": ["A lens {h} cm across", "Eine {h} cm große Linse"],
  "thing.mirror": ["A mirror {h} cm wide", "Ein {h} cm breiter Spiegel"],
  "thing.polarizer": ["A polarizer {h} cm wide", "Ein {h} cm breiter Polfilter"],
  "thing.polyhedron": ["A solid with flat faces", "Ein Körper mit ebenen Flächen"],
  "thing.graded": ["A piece of [[graded|graded]] glass {h} cm wide", "Ein {h} cm breites Stück Glas mit [[Verlauf|graded]]"],
  "thing.ball-body": ["A ball {h} cm across", "Eine {h} cm große Kugel"],
  "thing.rod-body": ["A rod {h} cm thick", "Ein {h} cm dicker Stab"],
  "thing.body": ["A block", "Ein Block"],
  stands: ["{thing} stands in front of {photo}.", "{thing} steht vor {photo}."],
  "stands.more": ["{thing} and {n} more stand in front of {photo}.", "{thing} und {n} weitere stehen vor {photo}."],
  nothing: ["Nothing stands in front of {photo}: a perfect [[cloak|cloak]] should look like this.", "Nichts steht vor {photo}: So sollte eine perfekte [[Tarnung|cloak]] aussehen."],
  nobody: ["There is no device in this scene.", "In dieser Szene steht kein Gerät."],
  bare: ["It has no cloak: it hides what is behind, and mirrors what is before it.", "Es hat keine Tarnung: Es verdeckt, was dahinter ist, und spiegelt, was davor ist."],
  mirror: ["Instead of it one sees what the [[cloak|cloak]] imitates: a flat mirror.", "Statt dessen sieht man, was die [[Tarnung|cloak]] nachahmt: einen ebenen Spiegel."],
  "mirror.edge": ["Instead of it one sees what the [[cloak|cloak]] imitates: a flat mirror, edge-on. So there is nothing to be seen.",
    "Statt dessen sieht man, was die [[Tarnung|cloak]] nachahmt: einen ebenen Spiegel, genau von der Kante. Also sieht man nichts."],
  // Captions: what one sees, and why.
  "cloak.straight": ["The [[cloak|cloak]] leads light around it and on as before: one sees what is behind, as if nothing were there.",
    "Die [[Tarnung|cloak]] führt das Licht darum herum und weiter wie zuvor: Man sieht, was dahinter ist, als wäre nichts da."],
  "cloak.almost": ["The [[cloak|cloak]] of [[graded|graded]] glass leads light around it: one sees what is behind, a little bent where the glass is cut off.",
    "Die [[Tarnung|cloak]] aus Glas mit [[Verlauf|graded]] führt das Licht darum herum: Man sieht, was dahinter ist, ein wenig gebogen, wo das Glas abgeschnitten ist."],
  "cloak.turned": ["The [[cloak|cloak]] leads light around it; turned by {r}° it looks like a mirror: to light it is a flat [[sheet|sheet]] of metal, invisible edge-on only.",
    "Die [[Tarnung|cloak]] führt das Licht darum herum; um {r}° gedreht sieht sie wie ein Spiegel aus: Für das Licht ist sie ein flaches [[Blech|sheet]], und das ist nur genau von der Kante unsichtbar."],
  "cloak.aside": ["The [[cloak|cloak]] leads light around it; seen {r}° beside its axis it looks like a mirror: to light it is a flat [[sheet|sheet]] of metal, invisible edge-on only.",
    "Die [[Tarnung|cloak]] führt das Licht darum herum; {r}° neben ihrer Achse sieht sie wie ein Spiegel aus: Für das Licht ist sie ein flaches [[Blech|sheet]], und das ist nur genau von der Kante unsichtbar."],
  "cloak.round": ["The [[cloak|cloak]] leads light around it and on as before, whichever way it comes: turn it, and nothing changes.",
    "Die [[Tarnung|cloak]] führt das Licht darum herum und weiter wie zuvor, woher es auch kommt: Beim Drehen ändert sich nichts."],
  "cloak.half": ["The [[cloak|cloak]] around it works for one [[polarization|polarization]] only: half of the light is led around, the other half meets the metal and lays a false picture over the true one. A {p} polarizer takes that away.",
    "Die [[Tarnung|cloak]] darum wirkt nur für eine [[Polarisation|polarization]]: Die eine Hälfte des Lichts wird herumgeführt, die andere trifft das Metall und legt ein falsches Bild über das richtige. Ein {p} gestellter Polfilter nimmt es weg."],
  "cloak.through": ["The {p} polarizer lets only that [[polarization|polarization]] pass that is led around.", "Der {p} gestellte Polfilter lässt nur die [[Polarisation|polarization]] durch, die herumgeführt wird."],
  "cloak.wrong": ["The {p} polarizer lets only that [[polarization|polarization]] pass that is not led around: one sees the metal in its block.",
    "Der {p} gestellte Polfilter lässt nur die [[Polarisation|polarization]] durch, die nicht herumgeführt wird: Man sieht das Metall in seinem Block."],
  "cloak.carpet": ["The [[carpet|carpet]] over it bends light so that the floor looks flat: the mirror image is straight.",
    "Der [[Teppich|carpet]] darüber biegt das Licht so, dass der Boden flach aussieht: Das Spiegelbild ist gerade."],
  "cloak.detour": ["The mirrors lead light around what stands between them; parallel light does not notice, but it comes late.",
    "Die Spiegel führen Licht um das herum, was zwischen ihnen steht; paralleles Licht merkt nichts, kommt aber später an."],
  "cloak.detour.eye": ["The mirrors lead light around what stands between them, but only light that comes straight: an eye sees slanted light, too, and so the trick.",
    "Die Spiegel führen Licht um das herum, was zwischen ihnen steht, aber nur gerades: Ein Auge sieht auch schräges Licht, und damit den Trick."],
  "cloak.prisms": ["Each prism bends light another way: a cloak need not be more than this. Drag its corners in the cross-section.",
    "Jedes Prisma biegt Licht anders: Mehr braucht eine Tarnung nicht. Seine Ecken lassen sich im Schnitt verschieben."],
  "cloak.open": ["Its core is open: what stands in it is hidden as long as it is not turned.", "Ihr Kern ist offen: Was darin steht, ist verborgen, solange sie nicht gedreht ist."],
  "see.invisible-sphere": ["Light makes a loop in it and goes on as before: only a clock can tell that it is there.", "Licht macht darin eine Schleife und geht weiter wie zuvor: Nur eine Uhr merkt, dass sie da ist."],
  "see.invisible-sphere-regularized": ["Made of crystal it is invisible for half of the light; the other half is refracted as by dense glass.", "Aus Kristall ist sie für die Hälfte des Lichts unsichtbar; die andere Hälfte wird gebrochen wie von dichtem Glas."],
  "see.bending-sphere": ["It turns all light by {a}°: in it one sees what is beside and above.", "Sie dreht alles Licht um {a}°: Man sieht in ihr, was daneben und darüber ist."],
  "see.eaton-lens": ["It sends all light back where it came from: in it one sees what is behind the camera.", "Sie schickt alles Licht dorthin zurück, woher es kam: Man sieht in ihr, was hinter der Kamera ist."],
  "see.luneburg-lens": ["It gathers parallel light in one point of its far side: in it the world stands upside down.", "Sie sammelt paralleles Licht in einem Punkt ihrer Rückseite: In ihr steht die Welt auf dem Kopf."],
  "see.fisheye-lens": ["It images each point of its surface to the opposite one.", "Sie bildet jeden Punkt ihrer Oberfläche auf den gegenüberliegenden ab."],
  "see.fisheye-hemisphere": ["Half of it gathers light that comes straight onto the cut in one point of its round side.", "Ihre Hälfte sammelt Licht, das gerade auf den Schnitt fällt, in einem Punkt der runden Seite."],
  "see.graded-box": ["Light bends to where the [[index|index]] is larger, as over a hot road or a cold sea.", "Licht biegt sich dorthin, wo die [[Brechzahl|index]] größer ist, wie über heißer Straße oder kaltem Meer."],
  "see.graded": ["Its [[index|index]] changes from place to place, so light goes in curves.", "Seine [[Brechzahl|index]] ändert sich von Ort zu Ort, also geht Licht in Kurven."],
  "see.lens": ["It bends light at two curved faces, and shows what is behind larger or smaller.", "Sie bricht Licht an zwei gewölbten Flächen und zeigt, was dahinter ist, größer oder kleiner."],
  "see.mirror": ["It shows what is before it.", "Er zeigt, was vor ihm ist."],
  "see.polarizer": ["It lets one [[polarization|polarization]] pass.", "Er lässt eine [[Polarisation|polarization]] durch."],
  "see.polyhedron": ["Light is refracted at its faces and reflected within.", "Licht wird an seinen Flächen gebrochen und innen gespiegelt."],
  "see.body": ["Light is refracted at its surface, and part of it is reflected.", "Licht wird an der Oberfläche gebrochen, und ein Teil gespiegelt."],
  "see.rod-in-water": ["A rod stands in a glass of water. Below the surface it looks wide, and moved.", "Ein Stab steht in einem Glas Wasser. Unter der Oberfläche sieht er breit und verschoben aus."],
  "see.rod-in-negative-water": ["A rod stands in a liquid of negative [[index|index]]: light is refracted to the wrong side, and so the rod below the surface stands on the wrong side of the glass.",
    "Ein Stab steht in einer Flüssigkeit mit negativer [[Brechzahl|index]]: Licht wird zur falschen Seite gebrochen, und so steht der Stab unter der Oberfläche auf der falschen Seite des Glases."],
  "see.rod-in-matched-negative-water": ["A rod stands in a liquid of negative [[index|index]] that reflects nothing: below the surface it stands on the wrong side of the glass.",
    "Ein Stab steht in einer Flüssigkeit mit negativer [[Brechzahl|index]], die nichts spiegelt: Unter der Oberfläche steht er auf der falschen Seite des Glases."],
  "see.quartz-wedge": ["Between crossed polarizers quartz is bright or dark by its thickness: it delays one [[polarization|polarization]] against the other.",
    "Zwischen gekreuzten Polfiltern ist Quarz je nach Dicke hell oder dunkel: Es verzögert die eine [[Polarisation|polarization]] gegen die andere."],
  "see.coated-panes": ["Left bare glass, which mirrors the room; in the middle a coating that mirrors hardly anything; right a thin film of silver.",
    "Links blankes Glas, das den Raum spiegelt; in der Mitte eine Schicht, die kaum spiegelt; rechts ein dünner Silberfilm."],
  "see.imperfect": ["What it is made of is off its design, so the picture is disturbed.", "Sein Material weicht vom Entwurf ab, also ist das Bild gestört."],
  "see.polarizer.camera": ["One looks through a {p} polarizer.", "Man schaut durch einen {p} gestellten Polfilter."],
  "see.wavelength": ["The light has one color, of {n} nm.", "Das Licht hat eine Farbe, von {n} nm."],
  "see.map": ["The colors are no picture but a map: {map}.", "Die Farben sind kein Bild, sondern eine Karte: {map}."],
  "see.flight": ["The photograph flashes once: only what arrives at that moment is bright. A flash may come later than the crests of its waves, by which the numbers and the drawing count.",
    "Das Foto blitzt einmal auf: Hell ist nur, was in diesem Augenblick ankommt. Ein Blitz kann später kommen als die Kämme seiner Wellen, nach denen Zahlen und Zeichnung gehen."],
  "see.fault": ["The picture is the last one that could be made.", "Das Bild ist das letzte, das zu machen war."],
  "see.beside": ["Left of the divider: {left}.", "Links vom Teiler: {left}."],

  // The tour.
  "tour.of": ["Step {n} of {all}", "Schritt {n} von {all}"],
  "tour.1": ["A camera looks at a photograph that hangs 50 cm behind the middle of the scene. Between them there is nothing yet. Remember this picture: a perfect cloak must look like it.",
    "Eine Kamera schaut auf ein Foto, das 50 cm hinter der Mitte der Szene hängt. Dazwischen ist noch nichts. Dieses Bild merken: So muss eine perfekte Tarnung aussehen."],
  "tour.2": ["Now a bar of metal lies across the view. It hides the middle of the photograph. In the cross-section the light of one point, the red line, ends up elsewhere.",
    "Nun liegt ein Metallstab quer im Blick. Er verdeckt die Mitte des Fotos. Im Schnitt landet das Licht eines Punkts, die rote Linie, anderswo."],
  "tour.3": ["The metal is still there, but four pieces around it, the cloak, lead light past it and back onto its line. Nothing is to be seen: compare by the divider.",
    "Das Metall ist noch da, aber vier Stücke darum, die Tarnung, führen Licht daran vorbei und zurück auf seine Linie. Man sieht nichts davon: mit dem Teiler vergleichen."],
  "tour.4": ["Turned by 10° the cloak betrays itself: it makes the bar look as thin as a sheet of metal. Edge-on a sheet is invisible; tilted it is a mirror, in which the shelf appears again.",
    "Um 10° gedreht verrät sich die Tarnung: Sie lässt den Stab so dünn aussehen wie ein Blech. Von der Kante ist ein Blech unsichtbar; gekippt ist es ein Spiegel, in dem das Regal noch einmal erscheint."],
  "tour.5": ["A simpler cloak works for one polarization only: half of the light is led around, the other half draws the false picture, which the polarizer takes away, but for some of it far from the middle, where light comes slanted. Take the polarizer away, and put it back.",
    "Eine einfachere Tarnung wirkt nur für eine Polarisation: Die Hälfte des Lichts wird herumgeführt, die andere malt das falsche Bild. Der Polfilter nimmt es weg, bis auf einen Rest abseits der Mitte, wo das Licht schräg kommt. Den Polfilter wegnehmen und wieder davorsetzen."],
  "tour.polarizer": ["Polarizer on or off", "Polfilter an oder aus"],

  // The glossary.
  "term.cloak": ["A shell that leads light around what it hides, and on as if nothing had been there.", "Eine Hülle, die Licht um das herumführt, was sie verbirgt, und weiter, als wäre nichts gewesen."],
  "term.sheet": ["The cloak squeezes the metal, for light, to a sheet without thickness. Edge-on it covers nothing; from any other side it reflects.", "Die Tarnung drückt das Metall, für das Licht, zu einem Blech ohne Dicke zusammen. Von der Kante verdeckt es nichts; von jeder anderen Seite spiegelt es."],
  "term.index": ["How many times slower the wave goes than in air; at a step of it light bends. Colors show the mean over the directions.", "Wievielmal langsamer die Welle läuft als in Luft; wo sie springt, knickt das Licht. Farben zeigen das Mittel über die Richtungen."],
  "term.graded": ["The index changes smoothly from place to place, so light goes in curves.", "Die Brechzahl ändert sich stetig von Ort zu Ort, also geht Licht in Kurven."],
  "term.polarization": ["The direction in which the electric field of light swings. Daylight has all of them; a polarizer lets one pass.", "Die Richtung, in der das elektrische Feld des Lichts schwingt. Tageslicht hat alle; ein Polfilter lässt eine durch."],
  "term.carpet": ["A cloak that makes a bump on a mirror look flat, so that one can hide under it.", "Eine Tarnung, die eine Beule auf einem Spiegel flach aussehen lässt, so dass man sich darunter verstecken kann."],
  "term.branch": ["At each border light splits: one part goes on, one is reflected, in crystals there are two of each. Each part is a branch.", "An jeder Grenze teilt sich Licht: Ein Teil geht weiter, einer wird gespiegelt, in Kristallen je zwei. Jeder Teil ist ein Zweig."],
  "term.likeness": ["Structural similarity (SSIM): 1 is the same picture. It compares pictures, and does not ask why they are alike.", "Strukturelle Ähnlichkeit (SSIM): 1 ist dasselbe Bild. Sie vergleicht Bilder und fragt nicht, warum sie sich gleichen."],
};

export const LANGUAGES = ["en", "de"];
const KEPT = "cloakroom.language";

// What is remembered is nothing where a page may remember nothing.
function remembered() {
  try {
    return localStorage.getItem(KEPT);
  } catch {
    return null;
  }
}

export let language = LANGUAGES.find((one) => one === remembered()) ?? (/^de\b/i.test(navigator.language) ? "de" : "en");

export function setLanguage(chosen, remember = true) {
  language = LANGUAGES.includes(chosen) ? chosen : "en";
  document.documentElement.lang = language;
  if (!remember) return;
  try {
    localStorage.setItem(KEPT, language);
  } catch {
    // It holds for this time.
  }
}

export const has = (key) => key in TABLE;

// A text, with what is put in.
export function say(key, put = {}) {
  const text = TABLE[key]?.[LANGUAGES.indexOf(language)] ?? key;
  return text.replace(/\{(\w+)\}/g, (_, name) => put[name] ?? "");
}

// The same without the marks of the glossary.
export const plain = (key, put) => say(key, put).replace(/\[\[([^|\]]*)\|\w+\]\]/g, "$1");

// What a key is called: it may be followed by a component of it.
export function nameOfKey(name) {
  const [, key, rest] = /^(\S+)(.*)$/.exec(name);
  return (has(`key.${key}`) ? say(`key.${key}`) : key.replaceAll("_", " ")) + rest;
}

// A number as people write it.
export const number = (value, digits = 1) => value.toLocaleString(language, { maximumFractionDigits: digits, useGrouping: false });

// Writes a text into an element, its terms as buttons that explain themselves.
export function write(element, text) {
  const parts = text.split(/\[\[([^|\]]*)\|(\w+)\]\]/);
  const nodes = [];
  for (let i = 0; i < parts.length; i += 3) {
    nodes.push(parts[i]);
    if (i + 2 >= parts.length) break;
    const term = document.createElement("button");
    term.type = "button";
    term.className = "term";
    term.dataset.term = parts[i + 2];
    term.textContent = parts[i + 1];
    nodes.push(term);
  }
  element.replaceChildren(...nodes);
}

// Writes what the page says everywhere; `data-say` names the text of an element, `data-say-ATTRIBUTE` that of an attribute.
export function writeAll() {
  document.documentElement.lang = language;
  for (const element of document.querySelectorAll("[data-say]")) write(element, say(element.dataset.say));
  for (const [attribute, name] of [["aria-label", "sayLabel"], ["title", "sayTitle"], ["placeholder", "sayPlaceholder"]]) {
    const marked = `[data-${name.replace(/[A-Z]/g, (c) => `-${c.toLowerCase()}`)}]`;
    for (const element of document.querySelectorAll(marked)) element.setAttribute(attribute, plain(element.dataset[name]));
  }
}
