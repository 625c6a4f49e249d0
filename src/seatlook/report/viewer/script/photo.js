// A photo of a fabric, made small enough, and as text so that it can be sent.

import { bytesOf } from "./drawing/payload.js";

const MOST = 1024;  // pixels along a side
const HEAVIEST = 40e6;  // bytes of a file

/**
 * @param {Blob} file
 * @returns {Promise<{picture: ImageBitmap, data: string}>}
 */
export async function readPhoto(file) {
  if (file.size > HEAVIEST) throw new Error(`the photo has ${(file.size / 1e6).toFixed(0)} MB; up to 40 are read`);
  const whole = await createImageBitmap(file);
  const times = Math.min(1, MOST / Math.max(whole.width, whole.height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(times * whole.width));
  canvas.height = Math.max(1, Math.round(times * whole.height));
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser draws no pictures");
  context.imageSmoothingQuality = "high";
  context.drawImage(whole, 0, 0, canvas.width, canvas.height);
  const data = canvas.toDataURL("image/jpeg", 0.92).split(",")[1];
  // As it would be sent, so that it looks the same elsewhere.
  return { picture: await photoOf(data), data };
}

/** @param {string} data base64 of a JPEG */
export async function photoOf(data) {
  return createImageBitmap(new Blob([bytesOf(data)], { type: "image/jpeg" }));
}
