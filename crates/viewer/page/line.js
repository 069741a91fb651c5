// The line to the server.

export const words = {
  lost: "The server has ended, or cannot be reached.",
  refused: "No connection: ten pages may be open already, or the server has ended.",
};

export function openLine() {
  const line = new WebSocket(`ws://${location.host}${location.pathname}session`);
  line.binaryType = "arraybuffer";
  return line;
}
