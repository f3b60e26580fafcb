// Spectra and filters, with the conventions of the program's `dsp`: one-sided, amplitudes of a sine at its line.

// Cosines and sines of a transform of `n`, kept from one to the next.
const circles = new Map();

function circle(n) {
  if (!circles.has(n)) {
    const of = (f) => Float64Array.from({ length: n / 2 }, (_, k) => f(2 * Math.PI * k / n));
    circles.set(n, [of(Math.cos), of(Math.sin)]);
  }
  return circles.get(n);
}

// Fourier transform in place, of a power of two.
export function fft(re, im) {
  const n = re.length, [cosines, sines] = circle(n);
  for (let i = 1, j = 0; i < n; i += 1) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      const x = re[i], y = im[i];
      re[i] = re[j]; im[i] = im[j];
      re[j] = x; im[j] = y;
    }
  }
  for (let length = 2; length <= n; length <<= 1) {
    const half = length >> 1, stride = n / length;
    for (let first = 0; first < n; first += length) {
      for (let k = first, at = 0; k < first + half; k += 1, at += stride) {
        const c = cosines[at], s = sines[at], x = re[k + half], y = im[k + half];
        const xr = x * c + y * s, xi = y * c - x * s;
        re[k + half] = re[k] - xr; im[k + half] = im[k] - xi;
        re[k] += xr; im[k] += xi;
      }
    }
  }
}

const hannWindows = new Map();

function hann(n) {
  if (!hannWindows.has(n)) hannWindows.set(n, Float64Array.from({ length: n }, (_, i) => 0.5 - 0.5 * Math.cos(2 * Math.PI * i / n)));
  return hannWindows.get(n);
}

// Mean amplitude spectrum over segments that overlap by a half, Hann's window; `n` is a power of two.
export function spectrum(signal, rate, n) {
  const power = new Float64Array(n / 2 + 1), re = new Float64Array(n), im = new Float64Array(n);
  const starts = [];
  for (let first = signal.length - n; first >= 0; first -= n / 2) starts.push(first);
  // Two segments are one transform: the powers of its two halves add up to those of both.
  for (let at = 0; at < starts.length; at += 2) {
    windowed(signal, starts[at], re);
    if (at + 1 < starts.length) windowed(signal, starts[at + 1], im); else im.fill(0);
    fft(re, im);
    for (let k = 0; k <= n / 2; k += 1) {
      const back = (n - k) % n;
      power[k] += 0.5 * (re[k] * re[k] + im[k] * im[k] + re[back] * re[back] + im[back] * im[back]);
    }
  }
  // The window has a mean of one half.
  const scale = 2 / (0.5 * n);
  const amplitude = power.map((p) => scale * Math.sqrt(p / Math.max(1, starts.length)));
  return { amplitude, step: rate / n, segments: starts.length };
}

// A segment without its mean, under the window.
function windowed(signal, first, out) {
  const window = hann(out.length);
  let mean = 0;
  for (let i = 0; i < out.length; i += 1) mean += signal[first + i];
  mean /= out.length;
  for (let i = 0; i < out.length; i += 1) out[i] = (signal[first + i] - mean) * window[i];
}

// Envelope of what lies in a band [Hz], of the last power of two of samples.
export function envelope(signal, rate, low, high) {
  let n = 1;
  while (2 * n <= signal.length) n *= 2;
  const re = new Float64Array(n), im = new Float64Array(n), first = signal.length - n;
  for (let i = 0; i < n; i += 1) re[i] = signal[first + i];
  fft(re, im);
  for (let k = 0; k < n; k += 1) {
    const hz = k * rate / n, kept = k <= n / 2 && hz >= low && hz <= high ? 2 : 0;
    re[k] *= kept; im[k] *= kept;
  }
  // The inverse transform is the transform with both parts exchanged.
  fft(im, re);
  return re.map((x, i) => Math.sqrt(x * x + im[i] * im[i]) / n);
}

// Second-order notch of the quality factor q, forwards and backwards: zero phase, as in the paper.
export function notch(signal, rate, hz, q) {
  const w = 2 * Math.PI * hz / rate, alpha = Math.sin(w) / (2 * q), c = -2 * Math.cos(w);
  const [b0, b1, b2, a1, a2] = [1, c, 1, c, 1 - alpha].map((x) => x / (1 + alpha));
  const once = (x) => {
    const y = new Float64Array(x.length);
    let [x1, x2, y1, y2] = [x[0] || 0, x[0] || 0, x[0] || 0, x[0] || 0];
    for (let i = 0; i < x.length; i += 1) {
      const out = b0 * x[i] + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1; x1 = x[i];
      y2 = y1; y1 = out;
      y[i] = out;
    }
    return y;
  };
  return once(once(signal).reverse()).reverse();
}

export function rms(signal) {
  let sum = 0;
  for (const x of signal) sum += x * x;
  return Math.sqrt(sum / Math.max(1, signal.length));
}

// Highest line within `reach` of a frequency, and how far it stands above the median of what lies about it [dB].
export function lineNear({ amplitude, step }, hz, reach) {
  const from = Math.max(1, Math.round((hz - reach) / step)), to = Math.min(amplitude.length - 1, Math.round((hz + reach) / step));
  if (!(to >= from)) return null;
  let at = from;
  for (let k = from; k <= to; k += 1) if (amplitude[k] > amplitude[at]) at = k;
  const about = [];
  for (let k = Math.max(1, at - 24); k <= Math.min(amplitude.length - 1, at + 24); k += 1) if (Math.abs(k - at) > 2) about.push(amplitude[k]);
  about.sort((a, b) => a - b);
  return { hz: at * step, level: amplitude[at], above: 20 * Math.log10(amplitude[at] / Math.max(1e-300, about[about.length >> 1])) };
}

// The last samples of a run, in columns, in a ring of constant size.
export class Record {
  constructor(columns, size) { this.columns = Array.from({ length: columns }, () => new Float64Array(size)); this.size = size; this.clear(); }

  clear() { this.count = 0; this.next = 0; }

  add(samples) {
    const width = this.columns.length, rows = samples.length / width;
    for (let r = Math.max(0, rows - this.size); r < rows; r += 1) {
      for (let c = 0; c < width; c += 1) this.columns[c][this.next] = samples[r * width + c];
      this.next = (this.next + 1) % this.size;
    }
    this.count = Math.min(this.size, this.count + rows);
  }

  // The last `n` of a column.
  last(column, n) {
    const take = Math.min(n, this.count), out = new Float64Array(take), from = this.columns[column];
    const first = (this.next - take + this.size) % this.size, head = Math.min(take, this.size - first);
    out.set(from.subarray(first, first + head));
    out.set(from.subarray(0, take - head), head);
    return out;
  }
}
