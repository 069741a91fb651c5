// The line to the server.

// What is said when nobody is at the other end, and whether its links are good elsewhere.
export const words = { lost: "lost.server", refused: "refused.server", copied: "copied.here" };

export function openLine() {
  const line = new WebSocket(`ws://${location.host}${location.pathname}session`);
  line.binaryType = "arraybuffer";
  return line;
}
