// Binary frame 1 of the protocol: points of the scope, one value each or least and greatest.

export interface Points {
  recording: number;
  from_us: number; // the window that was asked for
  to_us: number;
  times: Float64Array; // s
  channels: (number | null)[][];
}

export function readPoints(frame: DataView, from_us: number, to_us: number): Points {
  const channel_count = frame.getUint8(1);
  const per_point = frame.getUint8(2) || 1;
  const point_count = frame.getUint32(12, true);
  const step_us = frame.getUint32(16, true);
  const first_us = Number(frame.getBigUint64(24, true));
  const times = new Float64Array(point_count * per_point);
  const channels: (number | null)[][] = Array.from({ length: channel_count }, () => []);
  let offset = 32;
  for (let point = 0; point < point_count; ++point) {
    // Least and greatest stand one above the other, so that no peak is lost.
    times.fill((first_us + point * step_us) / 1e6, point * per_point, (point + 1) * per_point);
    for (const channel of channels) {
      for (let n = 0; n < per_point; ++n, offset += 4) {
        const value = frame.getFloat32(offset, true);
        channel.push(Number.isNaN(value) ? null : value);
      }
    }
  }
  return { recording: frame.getUint32(8, true), from_us, to_us, times, channels };
}
