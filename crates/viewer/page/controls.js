// The parameters of a device as sliders, built from the catalogue.

import { nameOfKey as words, nameOfValue, say } from "./words.js";

const keys = document.getElementById("keys");

// The range of a slider: the limits of the key where it has two, else around its default.
function range(schema) {
  const [low, high] = [schema.minimum ?? schema.exclusiveMinimum, schema.maximum ?? schema.exclusiveMaximum];
  if (low !== undefined && high !== undefined && high - low <= 1e4) return [low, high];
  const size = Math.abs(schema.default ?? 10) || 10;
  const least = schema.default === 0 ? 0 : 0.1 * size;
  return [low !== undefined && low >= 0 ? least : -2.5 * size, 2.5 * size];
}

// A slider and a field for one number; `set` is told with the value, and whether more will follow.
function number(name, schema, value, set) {
  const whole = schema.type === "integer";
  const [low, high] = range(schema);
  const slider = document.createElement("input");
  slider.type = "range";
  slider.min = low;
  slider.max = high;
  slider.step = whole ? 1 : "any";
  slider.value = value ?? "";
  const field = document.createElement("input");
  field.type = "number";
  field.step = whole ? 1 : "any";
  field.value = value ?? "";
  field.placeholder = say("none");
  slider.setAttribute("aria-label", words(name));
  field.setAttribute("aria-label", say("exactly", { name: words(name) }));
  const shown = (value) => Number(Number(value).toPrecision(4));
  slider.addEventListener("input", () => {
    field.value = shown(slider.value);
    set(shown(slider.value), true);
  });
  slider.addEventListener("change", () => set(shown(slider.value), false));
  field.addEventListener("change", () => {
    if (field.value === "") return set(undefined, false);
    if (!Number.isFinite(field.valueAsNumber)) return undefined;
    slider.value = field.value;
    return set(field.valueAsNumber, false);
  });
  return [slider, field];
}

function choice(options, value, set) {
  const select = document.createElement("select");
  for (const option of options) select.add(new Option(option === OWN ? say("written") : nameOfValue(option), option));
  select.value = value;
  select.addEventListener("change", () => set(select.value, false));
  return [select];
}

// The control of a key, or none where only the scene file can say it.
function control(name, schema, value, set) {
  const given = value ?? schema.default;
  if (schema.enum) return choice(schema.enum, given ?? schema.enum[0], set);
  if (schema.type === "number" || schema.type === "integer") return number(name, schema, given, set);
  // A permittivity, say: a number is one of the forms it may have.
  if (schema.anyOf?.some((one) => one.type === "number") && (given === undefined || typeof given === "number")) {
    return number(name, { type: "number", default: 1 }, given ?? 1, set);
  }
  if (schema.type === "boolean") {
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = Boolean(given);
    box.addEventListener("change", () => set(box.checked, false));
    return [box];
  }
  return undefined;
}

// The rows of a key: one, or one a component of a vector, or a group for a table.
function rowsOf(name, schema, value, set) {
  if (schema.type === "object") return [group(name, schema, value, set)];
  if (schema.type === "array" && schema.maxItems === 3 && schema.items.type === "number") {
    if (!(value ?? schema.default)) return [row(name, schema, parts(name, ["1", "2", "3"], [], (all) => set(all, false)))];
    const components = name === "color" ? ["red", "green", "blue"].map((one) => say(one)) : ["x", "y", "z"];
    const all = [...(value ?? schema.default)];
    const limits = { color: { maximum: 1 }, axis: { minimum: -1, maximum: 1 } }[name];
    return components.map((component, i) => {
      const one = { ...schema.items, default: schema.default[i] };
      const setOne = (value, moving) => {
        all[i] = value ?? schema.default[i];
        set([...all], moving);
      };
      const called = `${name} ${component}`;
      return row(called, schema, number(called, { ...one, ...limits }, all[i], setOne));
    });
  }
  if (schema.type === "array" && schema.items.type === "object") return [layers(name, schema, value, set)];
  const forms = formsOf(schema);
  const table = forms.find((one) => one.type === "object");
  const named = forms.find((one) => one.enum);
  if (table && !named) {
    const given = typeof value === "object" ? value : undefined;
    return [group(name, { ...table, description: schema.description }, given, set)];
  }
  // A material: a table or a file is for the scene file to say.
  if (named && !forms.some((one) => one.type === "number")) {
    const own = value === undefined || named.enum.includes(value) ? [] : [OWN];
    const shown = own.length > 0 ? OWN : (value ?? "");
    const select = choice(["", ...own, ...named.enum], shown, (chosen) => {
      set(chosen === OWN ? value : chosen === "" ? undefined : chosen, false);
    });
    select[0].setAttribute("aria-label", words(name));
    return [row(name, schema, select)];
  }
  if (isComplex(schema)) return [row(name, schema, complex(name, value, set))];
  const controls = control(name, schema, value, set);
  return controls ? [row(name, schema, controls)] : [];
}

// A material of the scene file's own.
const OWN = "as written";

// The forms that a key may have, those of its forms, too.
function formsOf(schema) {
  return (schema.anyOf ?? []).flatMap((one) => (one.anyOf ? formsOf(one) : [one]));
}

// Numbers that are given together or not at all.
function parts(name, labels, given, set) {
  const all = [...given];
  return labels.map((label, i) => {
    const field = document.createElement("input");
    field.type = "number";
    field.step = "any";
    field.value = all[i] ?? "";
    field.placeholder = label;
    field.setAttribute("aria-label", `${words(name)}, ${label}`);
    field.addEventListener("change", () => {
      all[i] = field.value === "" ? undefined : field.valueAsNumber;
      set(labels.every((_, j) => Number.isFinite(all[j])) ? [...all] : undefined);
    });
    return field;
  });
}

// Whether a key is a number or a pair of them and nothing else: an index n or [n, k].
function isComplex(schema) {
  const pair = schema.anyOf?.find((one) => one.type === "array" && one.items.type === "number");
  return pair?.maxItems === 2 && schema.anyOf.length === 2;
}

// The parts of an index; without a first one there is none.
function complex(name, value, set) {
  const given = typeof value === "number" ? [value, 0] : [...(value ?? [])];
  const fields = parts(name, ["n", "k"], given, () => {
    const [n, k] = fields.map((field) => (field.value === "" ? undefined : field.valueAsNumber));
    set(n === undefined ? undefined : k ? [n, k] : n, false);
  });
  return fields;
}

// A layer that is added to a coating: a quarter of a green wave of magnesium fluoride.
const NEW_LAYER = { index: 1.38, thickness_nm: 99.6 };

// A list of tables, the layers of a coating, from the outside inwards.
function layers(name, schema, value, set) {
  const all = [...(value ?? [])];
  const changed = (moving) => set(all.length > 0 ? [...all] : undefined, moving);
  const button = (text, action) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.addEventListener("click", () => {
      action();
      changed(false);
      details.replaceWith(layers(name, schema, all, set));
    });
    return made;
  };
  const { details, grid } = folded(name, schema);
  all.forEach((layer, i) => {
    const setter = (key) => (value, moving) => {
      const { [key]: _, ...others } = all[i];
      all[i] = value === undefined ? others : { ...others, [key]: value };
      changed(moving);
    };
    for (const [key, one] of Object.entries(schema.items.properties)) {
      // It says the same in other words.
      if (key === "permittivity" && layer.index !== undefined) continue;
      grid.append(...rowsOf(key, one, layer[key], setter(key)));
    }
    grid.append(button(say("removed", { n: i + 1 }), () => all.splice(i, 1)));
  });
  grid.append(button(say("added"), () => all.push({ ...NEW_LAYER })));
  return details;
}

// The keys of a table in a table.
function group(name, schema, value, set) {
  const entries = { ...value };
  const setter = (key) => (value, moving) => {
    if (value === undefined) delete entries[key];
    else entries[key] = value;
    set(Object.keys(entries).length > 0 ? { ...entries } : undefined, moving);
  };
  const { details, grid } = folded(name, schema);
  for (const [key, one] of Object.entries(schema.properties)) {
    grid.append(...rowsOf(key, one, entries[key], setter(key)));
  }
  return details;
}

// What opens to show the keys of a table, and where they go.
function folded(name, schema, called = words(name)) {
  const details = document.createElement("details");
  details.dataset.name = name;
  details.open = keys.querySelector(`details[data-name="${name}"]`)?.open ?? false;
  const summary = document.createElement("summary");
  summary.textContent = called;
  const hint = document.createElement("p");
  hint.className = "hint";
  hint.lang = "en";
  hint.textContent = schema.description ?? "";
  hint.hidden = !schema.description;
  const grid = document.createElement("div");
  grid.className = "keys";
  details.append(summary, hint, grid);
  return { details, grid };
}

let rowsMade = 0;

function row(name, schema, controls) {
  const line = document.createElement("div");
  line.className = "key";
  const unit = schema["x-unit"];
  // The label says the unit.
  line.title = (schema.description ?? "").replace(` Unit: ${unit}.`, "");
  const label = document.createElement(controls.length === 1 ? "label" : "span");
  label.append(words(name));
  if (unit) {
    const small = document.createElement("span");
    small.className = "unit";
    small.textContent = ` ${unit === "degrees" ? "°" : unit}`;
    label.append(small);
  }
  if (controls.length === 1) {
    controls[0].id = `key-${++rowsMade}`;
    label.htmlFor = controls[0].id;
    if (controls[0].type === "checkbox") {
      line.classList.add("flag");
      line.append(controls[0], label);
      return line;
    }
    const span = document.createElement("span");
    span.append(label);
    line.append(span, controls[0]);
    return line;
  }
  line.append(label, ...controls);
  return line;
}

// Ways to say what a medium is.
const MEDIUM = ["permittivity", "index", "uniaxial", "biaxial", "material"];

// The sizes that a body has, by its shape.
const SIZES = { slab: ["thickness"], box: ["size"], sphere: ["radius"], cylinder: ["radius", "length"] };

// Builds the controls of a device, or the `only` one; `changed` is told whether more changes will follow.
export function buildControls(device, kind, changed, only = null) {
  const rows = [];
  if (device && kind) {
    const sizes = device.kind === "body" ? Object.values(SIZES).flat() : [];
    const fits = (name) => !sizes.includes(name) || SIZES[device.shape ?? kind.keys.shape.default]?.includes(name);
    const setter = (name) => (value, moving) => {
      if (value === undefined) delete device[name];
      else {
        // A medium is said in one way, and another one may have no optic axis.
        if (MEDIUM.includes(name)) for (const other of [...MEDIUM, "optic_axis"]) delete device[other];
        device[name] = value;
      }
      if (name === "shape" && sizes.length > 0) {
        for (const size of sizes) if (!fits(size)) delete device[size];
        buildControls(device, kind, changed, only);
        keys.querySelector("select").focus();
      }
      changed(moving);
    };
    const rowsFor = (names) =>
      names.filter((name) => kind.keys[name] && fits(name)).flatMap((name) => rowsOf(name, kind.keys[name], device[name], setter(name)));
    if (only) {
      rows.push(...rowsFor([only]));
    } else {
      const core = kind.core_can_be_open ? ["core"] : [];
      const imperfection = kind.can_be_imperfect ? ["imperfection"] : [];
      const { details, grid } = folded("place", { description: "" }, say("place"));
      grid.append(...rowsFor(["length", "position", "axis", "metal", "coating", "dispersion", ...imperfection]));
      rows.push(...rowsFor([...kind.own_keys, ...core]), details);
    }
  }
  keys.replaceChildren(...rows);
}
