// The camera on its way around the devices.

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => a.map((x) => x / length(a));
const round = (x) => Math.round(x * 1e4) / 1e4 + 0;

// Turns a vector about an axis, radians.
function turned(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(v.map((x) => x * c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

const STEEPEST = (85 * Math.PI) / 180;

// Orbits the camera of a state about the point of its line of sight that is nearest to the first device; angles in
// degrees, to the right and up.
export function orbit(state, right, up) {
  const camera = state.scene.camera ?? {};
  const position = camera.position ?? [-100, 0, 0];
  const target = camera.target ?? [50, 0, 0];
  const vertical = unit(camera.up ?? [0, 1, 0]);
  const sight = unit(add(target, position, -1));
  const origin = state.devices[0]?.position ?? [0, 0, 0];
  const near = dot(add(origin, position, -1), sight);
  const distance = near > 1 ? near : length(add(target, position, -1));
  const pivot = add(position, sight, distance);
  const beyond = length(add(target, pivot, -1));
  let direction = turned(sight, vertical, (-right * Math.PI) / 180);
  const across = unit(cross(direction, vertical));
  const steep = Math.asin(Math.max(-1, Math.min(1, dot(direction, vertical))));
  const wanted = Math.max(-STEEPEST, Math.min(STEEPEST, steep - (up * Math.PI) / 180));
  direction = turned(direction, across, wanted - steep);
  state.table("camera").position = add(pivot, direction, -distance).map(round);
  state.table("camera").target = add(pivot, direction, Math.max(1, beyond)).map(round);
}

// Zooms by a factor: the width of the view, or its angle.
export function zoom(state, factor) {
  const camera = state.table("camera");
  if (camera.projection === "orthographic") {
    camera.width = round(Math.min(1e4, Math.max(0.1, camera.width * factor)));
    return;
  }
  const half = Math.tan(((camera.field_of_view ?? 40) * Math.PI) / 360) * factor;
  const angle = (Math.atan(half) * 360) / Math.PI;
  camera.field_of_view = round(Math.min(140, Math.max(0.5, angle)));
}
