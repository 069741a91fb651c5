// One turn of the device as a film: its pictures are made one by one, then played to the browser's recorder.

const FRAMES = 90;
const RATE = 30;
const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

export const canFilm = () => typeof MediaRecorder === "function" && TYPES.some((type) => MediaRecorder.isTypeSupported(type));

// `turn` shows the device at an angle and resolves once its picture is on the canvas; `told` is told the share that is done.
export async function film(canvas, from, turn, told) {
  const frames = [];
  for (let i = 0; i < FRAMES; i += 1) {
    await turn(from + (360 * i) / FRAMES);
    frames.push(await createImageBitmap(canvas));
    told((i + 1) / (FRAMES + FRAMES / 4));
  }
  const shown = document.createElement("canvas");
  // Encoders want even sides.
  [shown.width, shown.height] = [canvas.width & ~1, canvas.height & ~1];
  const context = shown.getContext("2d");
  context.drawImage(frames[0], 0, 0);
  const type = TYPES.find((one) => MediaRecorder.isTypeSupported(one));
  const recorder = new MediaRecorder(shown.captureStream(RATE), { mimeType: type, videoBitsPerSecond: 6e6 });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((resolve) => (recorder.onstop = resolve));
  recorder.start();
  for (const [i, frame] of frames.entries()) {
    context.drawImage(frame, 0, 0);
    frame.close();
    if (i % 10 === 0) told((FRAMES + i / 4) / (FRAMES + FRAMES / 4));
    await new Promise((resolve) => setTimeout(resolve, 1000 / RATE));
  }
  recorder.stop();
  await ended;
  return new Blob(parts, { type: type.split(";")[0] });
}
