//! What stands around the devices: camera, field of view, photograph, distances and axes.

use super::super::drawing::{Drawing, Face, Shape, Words};
use super::super::shrink::srgb;
use super::subject::{Subject, bounds, sides};
use super::view::View;
use super::{BLUE, GRAY, INK, PAPER, SKY, TEXT, THICK, THIN, centimetres, dimension, write};
use cloakroom::assembly::Screen;
use cloakroom::output::RgbImage;
use cloakroom::photograph::Pyramid;
use cloakroom::render::PreparedScene;
use cloakroom::scene::{Camera, CameraRay, Scene};
use glam::{DAffine2, DVec2};

/// How the photograph's width is drawn: it is seen a little from the side and from above.
const SLANT: DVec2 = DVec2::new(0.16, -0.06);
/// The radius of the eye that stands for the camera, units of the sheet.
pub(super) const EYE: f64 = 36.0;
/// The room that the row of distances needs above the view.
pub(super) const DISTANCES: f64 = 3.4 * TEXT;
/// The room that the axes of coordinates need.
pub(crate) const AXES: DVec2 = DVec2::new(4.2 * TEXT, 4.2 * TEXT);

/// Camera and photograph in the xy-plane, cm.
pub(super) struct Stage {
    /// Where the camera is.
    pub eye: DVec2,
    /// Where it looks, if that is not out of the page.
    forward: Option<DVec2>,
    /// What it sees up to the plane of the photograph, counterclockwise; empty if it looks out of
    /// the page.
    pub sight: Vec<DVec2>,
    screen: Screen,
    thumbnail: RgbImage,
}

impl Stage {
    pub fn new(scene: &Scene, prepared: &PreparedScene<'_>) -> Self {
        let camera = &scene.camera;
        let eye = camera.position.truncate();
        let forward = camera.forward().truncate();
        let forward = (forward.length() > 0.2).then(|| forward.normalize());
        let screen = prepared.screen;
        Self {
            eye,
            forward,
            sight: forward.map(|forward| sight(camera, forward, &screen)).unwrap_or_default(),
            screen,
            thumbnail: thumbnail(&prepared.image),
        }
    }

    /// The corners of the photograph as it is drawn: top left, top right, bottom right, bottom
    /// left.
    pub fn photograph(&self) -> [DVec2; 4] {
        let middle = self.screen.middle;
        [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(up, across)| {
            let corner = self.screen.point(up, across);
            corner.truncate() + (corner.z - middle.z) * SLANT
        })
    }

    /// Least and greatest x and y of all that is drawn of it.
    pub fn bounds(&self) -> [DVec2; 2] {
        let points = self.photograph().into_iter().chain(self.sight.iter().copied());
        bounds(points.chain([self.eye])).unwrap_or([self.eye, self.eye])
    }

    /// Draws what devices stand in front of.
    pub fn draw_behind(&self, drawing: &mut Drawing, view: &View) {
        if self.sight.len() > 2 {
            let area = drawing.add_area("field-of-view", view.places(&self.sight));
            area.filled(SKY.faint(0.16)).stroked(SKY, THIN);
        }
        let frame = self.photograph().map(|p| view.place(p));
        let [top_left, top_right, _, bottom_left] = frame;
        let (across, down) = (top_right - top_left, bottom_left - top_left);
        // Seen from its edge there is nothing of it to be seen.
        if across.perp_dot(down).abs() > 1.0 {
            let place = DAffine2::from_cols(across, down, top_left);
            let image = self.thumbnail.clone();
            drawing.add("photograph-image", Shape::Image { image, cells: false, place });
        }
        drawing.add_area("photograph-frame", frame).stroked(INK, THIN);
        let line = self.screen.middle_line().map(|end| view.place(end.truncate()));
        drawing.add_line("photograph", line, (INK, THIN));
    }

    /// Draws what stands before everything: the camera, and what the things are called.
    pub fn draw_before(&self, drawing: &mut Drawing, view: &View) {
        let eye = view.place(self.eye);
        match self.forward {
            Some(forward) => draw_eye(drawing, eye, DVec2::new(forward.x, -forward.y)),
            None => {
                let circle = |share: f64| Shape::Circle { centre: eye, radius: share * EYE };
                drawing.add("camera", circle(0.5)).filled(PAPER);
                drawing.add("pupil", circle(0.3)).filled(BLUE);
            }
        }
        let [camera, photograph] = self.labels(view);
        write(drawing, "camera-label", camera, PAPER);
        write(drawing, "photograph-label", photograph, PAPER);
    }

    /// What camera and photograph are called, where that is written.
    pub fn labels(&self, view: &View) -> [Words; 2] {
        let eye = view.place(self.eye);
        let name = |text: &str, at: DVec2| within(view, Words::new(text, at, TEXT));
        let back = self.forward.map_or(DVec2::ZERO, |f| 0.5 * EYE * DVec2::new(-f.x, f.y));
        let camera = name("camera", eye + back + DVec2::Y * (0.62 * EYE + 0.6 * TEXT));
        let corners = self.photograph().map(|p| view.place(p));
        let lowest = corners.iter().map(|p| p.y).fold(f64::MIN, f64::max);
        // Below the foot, which of one that leans is not below its middle.
        let [left, right] = [f64::min, f64::max].map(|end| {
            let foot = corners.iter().filter(|p| p.y > lowest - TEXT).map(|p| p.x);
            foot.reduce(end).unwrap_or_default()
        });
        let middle = view.place(self.screen.middle.truncate()).x;
        let foot = middle.clamp(left, right);
        [camera, name("photograph", DVec2::new(foot, lowest + 0.9 * TEXT))]
    }

    /// Draws how far camera, axes of devices and photograph are from each other along x, in a row
    /// above the view. Opaque bodies are scenery, and left out.
    pub fn draw_distances(&self, drawing: &mut Drawing, view: &View, subjects: &[Subject<'_>]) {
        let row = view.window[0].y - 0.8 * TEXT;
        let (x, middle) = (self.screen.middle.x, view.place(self.screen.middle.truncate()));
        // Down to where the photograph begins there.
        let corners = self.photograph().map(|p| view.place(p));
        let crossed = sides(&corners).filter_map(|(a, b)| {
            let share = (middle.x - a.x) / (b.x - a.x);
            (0.0..=1.0).contains(&share).then_some(a.y + share * (b.y - a.y))
        });
        let top = crossed.fold(middle.y, f64::min);
        let eye = view.place(self.eye) - DVec2::Y * 0.6 * EYE;
        let mut stations = vec![(self.eye.x, eye.y), (x, top)];
        let measured = |subject: &&Subject<'_>| subject.bounds().is_some() && !subject.is_opaque();
        for subject in subjects.iter().filter(measured) {
            let centre = view.place(subject.origin());
            drawing.add("device-axis", Shape::Circle { centre, radius: 3.2 }).filled(INK);
            stations.push((subject.origin().x, centre.y));
        }
        stations.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Those that stand close together are one station.
        let on_sheet = |x: f64| view.place(DVec2::new(x, 0.0)).x;
        stations.dedup_by(|a, b| {
            let same = (on_sheet(a.0) - on_sheet(b.0)).abs() < 0.8 * TEXT;
            b.1 = if same { b.1.max(a.1) } else { b.1 };
            same
        });
        for (x, y) in &stations {
            let x = view.place(DVec2::new(*x, 0.0)).x;
            let line = [DVec2::new(x, row - 6.0), DVec2::new(x, *y)];
            drawing.add_line("extension", line, (GRAY, 0.7 * THIN)).dashed(9.0, 5.0);
        }
        // How far the labels of each line reach; one without room goes to the next line above.
        let mut lines: Vec<f64> = Vec::new();
        for pair in stations.windows(2) {
            let [(from, _), (to, _)] = pair else { continue };
            let ends = [*from, *to].map(|x| DVec2::new(view.place(DVec2::new(x, 0.0)).x, row));
            dimension::double_arrow(drawing, "distance", ends);
            let words = Words::new(centimetres(to - from), (ends[0] + ends[1]) / 2.0, TEXT);
            let words = within(view, words);
            let half = words.width() / 2.0;
            let free = |reach: &f64| reach + 0.3 * TEXT < words.at.x - half;
            let line = lines.iter().position(free).unwrap_or(lines.len());
            match lines.get_mut(line) {
                Some(reach) => *reach = words.at.x + half,
                None => lines.push(words.at.x + half),
            }
            let at = words.at - DVec2::Y * (0.75 + line as f64) * TEXT;
            let words = Words { at, ..words };
            drawing.add_words("distance-label", words);
        }
    }
}

/// A label moved sideways so that it does not reach beyond the view and the margin beside it.
fn within(view: &View, words: Words) -> Words {
    let half = words.width() / 2.0;
    let [from, size] = view.window;
    let right = from.x + size.x + 0.8 * TEXT - half;
    let x = words.at.x.min(right).max(half + 6.0);
    Words { at: DVec2::new(x, words.at.y), ..words }
}

/// The field of view in the xy-plane: what its projection covers, up to the plane of the
/// photograph.
fn sight(camera: &Camera, forward: DVec2, screen: &Screen) -> Vec<DVec2> {
    let [width, height] = camera.resolution.map(f64::from);
    let eye = camera.position.truncate();
    let far = 1.5 * screen.ahead_of(camera.position).abs().max(1.0);
    // The middles of the sides of the picture, and its corners.
    let across = [0.5, 0.5, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0];
    let down = [0.0, 1.0, 0.5, 0.5, 0.0, 1.0, 0.0, 1.0];
    let line = |ray: CameraRay| {
        let (from, along) = (ray.origin.truncate(), ray.direction.truncate());
        let ahead = along.dot(forward);
        if ahead < 1e-6 {
            return None;
        }
        let to_plane = screen.distance_along(ray.origin, ray.direction);
        let length = if to_plane > 0.0 && to_plane * along.length() < 2.0 * far {
            to_plane
        } else {
            far / along.length()
        };
        // How far to the left it is where all have come equally far.
        let even = from + along * ((far - (from - eye).dot(forward)) / ahead);
        Some((forward.perp_dot(even - eye), [from, from + length * along]))
    };
    let border = across.into_iter().zip(down);
    let lines: Vec<_> =
        border.filter_map(|(u, v)| line(camera.ray(u * width, v * height))).collect();
    let right = lines.iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let left = lines.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    let (Some((_, right)), Some((_, left))) = (right, left) else { return Vec::new() };
    let mut corners = vec![right[0], right[1], left[1], left[0]];
    corners.dedup();
    if corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// A small copy of the photograph.
fn thumbnail(photograph: &Pyramid) -> RgbImage {
    const SIZE: [usize; 2] = [160, 360];
    let [width, height] = SIZE;
    let step = SIZE.map(|n| 1.0 / n as f64);
    let light = |k: usize| {
        let at = [((k % width) as f64 + 0.5) * step[0], ((k / width) as f64 + 0.5) * step[1]];
        photograph.sample(at, [step[0], 0.0], [0.0, step[1]])
    };
    srgb(SIZE, &(0..width * height).map(light).collect::<Vec<_>>())
}

/// An eye whose pupil is at a point, looking along a unit vector.
fn draw_eye(drawing: &mut Drawing, at: DVec2, forward: DVec2) {
    let back = at - forward * EYE;
    let ray = |degrees: f64, radius: f64| {
        back + radius * DVec2::from_angle(degrees.to_radians()).rotate(forward)
    };
    let arc = |half: f64, radius: f64| {
        (-12..=12).map(move |k| ray(half * f64::from(k) / 12.0, radius)).collect::<Vec<_>>()
    };
    let band = |half: f64, inner: f64| {
        let mut points = arc(half, EYE);
        points.extend(arc(half, inner).into_iter().rev());
        points
    };
    let mut ball = arc(30.0, EYE);
    ball.push(back);
    drawing.add_area("camera", ball).filled(PAPER);
    drawing.add_area("iris", band(18.0, 0.76 * EYE)).filled(BLUE);
    drawing.add_area("pupil", band(8.0, 0.84 * EYE)).filled(INK);
    drawing.add_line("cornea", arc(30.0, EYE), (INK, THIN));
    for lid in [-30.0, 30.0] {
        drawing.add_line("lid", [ray(lid, 0.0), ray(lid, 1.12 * EYE)], (INK, THICK));
    }
}

/// Draws the directions of x, y and z in a box of the sheet whose top left corner is at a point.
pub(crate) fn draw_axes(drawing: &mut Drawing, corner: DVec2) {
    let origin = corner + DVec2::new(0.26 * AXES.x, 0.74 * AXES.y);
    let length = 0.5 * AXES.x;
    for (name, direction) in [("x", DVec2::X), ("y", -DVec2::Y)] {
        let tip = origin + length * direction;
        let shaft = [origin + 7.0 * direction, tip - 8.0 * direction];
        drawing.add_line("coordinate", shaft, (INK, THIN));
        drawing.add("head", dimension::arrow_head(tip, -direction, dimension::HEAD)).filled(INK);
        let name = Words::of(Face::Italic, name, tip + 0.55 * TEXT * direction, TEXT);
        write(drawing, "coordinate-name", name, PAPER);
    }
    // z comes out of the page.
    drawing.add("coordinate", Shape::Circle { centre: origin, radius: 7.0 }).stroked(INK, THIN);
    drawing.add("coordinate", Shape::Circle { centre: origin, radius: 2.2 }).filled(INK);
    let name = Words::of(Face::Italic, "z", origin + DVec2::new(-0.65, 0.65) * TEXT, TEXT);
    write(drawing, "coordinate-name", name, PAPER);
}
