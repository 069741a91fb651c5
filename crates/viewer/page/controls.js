// The parameters of a device as sliders, built from the catalogue.

const keys = document.getElementById("keys");

const words = (name) => name.replaceAll("_", " ");

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
  field.placeholder = "none";
  slider.setAttribute("aria-label", words(name));
  field.setAttribute("aria-label", `${words(name)}, exactly`);
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
  for (const option of options) select.add(new Option(option, option));
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
    const components = name === "color" ? ["red", "green", "blue"] : ["x", "y", "z"];
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
  const controls = control(name, schema, value, set);
  return controls ? [row(name, schema, controls)] : [];
}

// The keys of a table in a table.
function group(name, schema, value, set) {
  const entries = { ...value };
  const setter = (key) => (value, moving) => {
    if (value === undefined) delete entries[key];
    else entries[key] = value;
    set(Object.keys(entries).length > 0 ? { ...entries } : undefined, moving);
  };
  const details = document.createElement("details");
  details.dataset.name = name;
  details.open = keys.querySelector(`details[data-name="${name}"]`)?.open ?? false;
  const summary = document.createElement("summary");
  summary.textContent = words(name);
  const hint = document.createElement("p");
  hint.className = "hint";
  hint.textContent = schema.description ?? "";
  const grid = document.createElement("div");
  grid.className = "keys";
  for (const [key, one] of Object.entries(schema.properties)) {
    grid.append(...rowsOf(key, one, entries[key], setter(key)));
  }
  details.append(summary, hint, grid);
  return details;
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

// Builds the controls of a device; `changed` is told whether more changes will follow.
export function buildControls(device, kind, changed) {
  const rows = [];
  if (device && kind) {
    const setter = (name) => (value, moving) => {
      if (value === undefined) delete device[name];
      else device[name] = value;
      changed(moving);
    };
    const placement = ["length", ...(kind.core_can_be_open ? ["core"] : []), "position", "axis", "imperfection"];
    for (const name of [...kind.own_keys, ...placement]) {
      if (kind.keys[name]) rows.push(...rowsOf(name, kind.keys[name], device[name], setter(name)));
    }
  }
  keys.replaceChildren(...rows);
}
