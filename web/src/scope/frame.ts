// Binary frame 1 of the protocol: points of the scope, one value each or least and greatest, of 32 or 64 bits.
import type { Points } from "../picture/points";

export interface Frame extends Points {
  recording: number;
}

const head_bytes = 32;

export function readFrame(frame: DataView, from_us: number, to_us: number): Frame {
  const channels = frame.getUint8(1);
  const per_point = frame.getUint8(2) || 1;
  const bytes = frame.getUint8(3) === 1 ? 8 : 4;
  const count = frame.getUint32(12, true);
  const read = (at: number) => (bytes === 8 ? frame.getFloat64(at, true) : frame.getFloat32(at, true));
  const least = Array.from({ length: channels }, () => new Float64Array(count));
  const greatest = per_point === 1 ? least : least.map(() => new Float64Array(count));
  let at = head_bytes;
  for (let point = 0; point < count; ++point)
    for (let channel = 0; channel < channels; ++channel)
      for (let n = 0; n < per_point; ++n, at += bytes) ((n === 0 ? least : greatest)[channel] as Float64Array)[point] = read(at);
  return {
    recording: frame.getUint32(8, true),
    from_us,
    to_us,
    first_us: Number(frame.getBigUint64(24, true)),
    step_us: frame.getUint32(16, true),
    count,
    least,
    greatest,
  };
}
