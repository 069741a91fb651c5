// One turn of the device as a film: its pictures are made one by one, then played to the browser's recorder, or written as GIF.

import { gif } from "./gif.js";

const FRAMES = 90;
const RATE = 30;
const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

// A GIF has no motion compensation: half the pictures, and no wider than this, or it is larger than one sends.
const GIF_STEP = 2;
const GIF_WIDTH = 480;

// The share of the work that is done when all pictures are made.
const MADE = 0.8;

export const canRecord = () => typeof MediaRecorder === "function" && TYPES.some((type) => MediaRecorder.isTypeSupported(type));

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

// `turn` shows the device at an angle and resolves once its picture is on the canvas; `told` is told the share that is done.
async function shoot(canvas, count, from, turn, told) {
  const frames = [];
  for (let i = 0; i < count; i += 1) {
    await turn(from + (360 * i) / count);
    frames.push(await createImageBitmap(canvas));
    told((MADE * (i + 1)) / count);
  }
  return frames;
}

// As the browser records it.
export async function recorded(canvas, from, turn, told) {
  const frames = await shoot(canvas, FRAMES, from, turn, told);
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
    if (i % 10 === 0) told(MADE + ((1 - MADE) * i) / FRAMES);
    await pause(1000 / RATE);
  }
  recorder.stop();
  await ended;
  return new Blob(parts, { type: type.split(";")[0] });
}

// As GIF, which goes into slides and messages.
export async function animated(canvas, from, turn, told) {
  const frames = await shoot(canvas, FRAMES / GIF_STEP, from, turn, told);
  const share = Math.min(1, GIF_WIDTH / canvas.width);
  const [width, height] = [canvas.width, canvas.height].map((side) => Math.max(1, Math.round(share * side)));
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  context.imageSmoothingQuality = "high";
  const images = frames.map((frame) => {
    context.drawImage(frame, 0, 0, width, height);
    frame.close();
    return context.getImageData(0, 0, width, height);
  });
  return gif(images, RATE / GIF_STEP, (done) => {
    told(MADE + (1 - MADE) * done);
    return pause(0);
  });
}
