// The sensor's signal as sound: a recorded loop at its true pitch, because no browser steps a bearing in real time.

export class Sound {
  constructor() { this.context = null; this.source = null; }

  get playing() { return this.source !== null; }

  stop() { if (this.source) { this.source.stop(); this.source = null; } }

  // Plays a signal round and round. Pairs of samples become one, so that every browser takes the rate.
  play(signal, rate) {
    this.stop();
    this.context = this.context || new AudioContext();
    const pairs = rate > 96000 ? 2 : 1, count = Math.floor(signal.length / pairs);
    if (count < 64 || rate / pairs < 8000) return false;
    const buffer = this.context.createBuffer(1, count, rate / pairs), to = buffer.getChannelData(0);
    let mean = 0, power = 0;
    for (let i = 0; i < count; i += 1) {
      let sum = 0;
      for (let k = 0; k < pairs; k += 1) sum += signal[i * pairs + k];
      to[i] = sum / pairs;
      mean += to[i] / count;
    }
    for (let i = 0; i < count; i += 1) { to[i] -= mean; power += to[i] * to[i] / count; }
    // A sine of the same power would peak at a fifth; impacts are limited. Ends are faded, so that the loop does not click.
    const gain = 0.14 / Math.max(1e-12, Math.sqrt(power)), fade = Math.min(400, count / 8);
    for (let i = 0; i < count; i += 1) to[i] = Math.tanh(gain * to[i]) * Math.min(1, i / fade, (count - 1 - i) / fade);
    this.source = this.context.createBufferSource();
    Object.assign(this.source, { buffer, loop: true });
    this.source.connect(this.context.destination);
    this.source.start();
    return true;
  }
}
