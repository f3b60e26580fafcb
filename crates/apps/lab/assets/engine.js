// The module and its bearing, and the loop that steps it: in a worker, or on the page where there is none.

// Place of the watched roller among the handles (`at` in `handles.rs`); others are looked up by name.
const ROLLER = 16;

export class Bearing {
  constructor(instance) {
    this.x = instance.exports;
    [this.perSample, this.beforeRollers, this.perRoller] = [0, 1, 2].map((n) => this.x.lab_layout(n));
  }

  give(bytes) {
    const at = this.x.lab_input(bytes.length);
    new Uint8Array(this.x.memory.buffer, at, bytes.length).set(bytes);
  }

  open(bytes) { this.give(bytes); this.sure(this.x.lab_open()); }
  goOnFrom(bytes) { this.give(bytes); this.sure(this.x.lab_go_on_from()); }

  // What a call said, or the reason why it failed.
  sure(code) {
    if (code >>> 0 !== 0xffffffff) return code;
    throw new Error(this.words() || "the module has no bearing");
  }

  words() {
    return new TextDecoder().decode(new Uint8Array(this.x.memory.buffer, this.x.lab_text(), this.x.lab_text_length()).slice());
  }

  numbers(address) {
    return new Float64Array(this.x.memory.buffer, address, this.x.lab_length()).slice();
  }

  ask(handle, value) { this.sure(this.x.lab_ask(handle, value)); }
  apply() { return this.sure(this.x.lab_apply()) === 1; }
  // Samples; `began` says why the run began anew behind them, where it did.
  run(samples) {
    this.began = this.sure(this.x.lab_run(samples)) === 1 ? this.words() : null;
    return this.numbers(this.x.lab_samples());
  }

  picture() { return this.numbers(this.x.lab_picture()); }
  displacement() { return this.numbers(this.x.lab_displacement()); }
  forces() { return this.numbers(this.x.lab_numbers(5)); }
  handles() { return this.numbers(this.x.lab_numbers(4)); }
  still() {
    const [outer, inner, roller, vertexAngles, handles] = [0, 1, 2, 3, 4].map((n) => this.numbers(this.x.lab_numbers(n)));
    return { outer, inner, roller, vertexAngles, handles };
  }
}

// Answers messages of the page through `say`; `now` is a clock in ms and `later` calls back soon.
export function serve(say, now, later) {
  // Every answer says of which bearing: those of the one before may still be on their way.
  let opened = -1;
  const post = (message, transfer) => say({ ...message, of: opened }, transfer);
  let module = null, bearing = null, content = null, interval = 0;
  let running = false, pace = 0, scheduled = false, unread = 0, batch = 4;
  let simulated = 0, since = 0, busy = 0;
  // As long as a turn may take [ms]: a picture comes 30 times a second and more.
  // A clock that stands still must not keep it: a limit on the samples.
  const TURN = 14, UNREAD = 2, MOST = 20000;

  const fresh = () => new Bearing(new WebAssembly.Instance(module, {}));
  const still = (extra) => post({ kind: "still", ...bearing.still(), perSample: bearing.perSample,
    beforeRollers: bearing.beforeRollers, perRoller: bearing.perRoller, ...extra });
  const picture = () => ({ picture: bearing.picture(), displacement: Float32Array.from(bearing.displacement()) });
  const schedule = () => {
    if (scheduled || !running || unread >= UNREAD) return;
    scheduled = true;
    later(turn);
  };

  function turn() {
    scheduled = false;
    if (!running || !bearing) return;
    const began = now();
    if (!since) { since = began; simulated = 0; busy = 0; }
    const due = pace > 0 ? Math.floor((pace * (began - since) / 1000 - simulated) / interval) : Infinity;
    const parts = [];
    let taken = 0, spent = 0, failure = null, anew = null;
    while (taken < Math.min(due, MOST) && spent < TURN && !anew) {
      const samples = Math.min(batch, due - taken);
      try { parts.push(bearing.run(samples)); } catch (error) { failure = error; break; }
      taken += samples;
      spent = now() - began;
      anew = bearing.began;
    }
    // As many samples between two readings of the clock as take about two milliseconds.
    if (spent > 0 && taken > 0) batch = Math.max(1, Math.min(4096, Math.round(taken * 2 / Math.max(spent, 0.2))));
    simulated += taken * interval;
    busy += now() - began;
    const elapsed = now() - since;
    let speed = null;
    if (elapsed > 500) {
      speed = { achieved: 1000 * simulated / elapsed, possible: 1000 * simulated / Math.max(busy, 0.01) };
      since = 0;
    }
    if (taken || failure) {
      const samples = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
      parts.reduce((at, part) => { samples.set(part, at); return at + part.length; }, 0);
      unread += 1;
      const shown = picture();
      post({ kind: "samples", samples, speed, memory: bearing.x.memory.buffer.byteLength, ...shown }, [samples.buffer, shown.picture.buffer, shown.displacement.buffer]);
    }
    if (anew) post({ kind: "began", why: anew });
    if (failure) {
      running = false;
      post({ kind: "stopped", why: failure.message });
      return;
    }
    schedule();
  }

  // The first milliseconds of the scene once more, beside those of the program: in one piece, and from states of
  // the program's run, because every strike makes a difference of rounding larger.
  function check(reference, states) {
    const every = reference[0], forces = reference.subarray(1), began = now();
    const alone = fresh(), guided = fresh();
    alone.open(content);
    guided.open(content);
    const perCheck = alone.forces().length, checks = forces.length / perCheck, pieces = states.length;
    const told = { alone: 0, guided: 0, largest: 0, close: 0, course: [] };
    const worst = (here, n) => here.reduce((off, force, i) => Math.max(off, Math.abs(force - forces[n * perCheck + i])), 0);
    for (const force of forces) told.largest = Math.max(told.largest, Math.abs(force));
    for (let n = 0; n < checks; n += 1) {
      if (n % (checks / pieces) === 0) guided.goOnFrom(states[n / (checks / pieces)]);
      alone.run(every);
      guided.run(every);
      told.guided = Math.max(told.guided, worst(guided.forces(), n));
      told.course.push(worst(alone.forces(), n));
      told.alone = Math.max(told.alone, told.course[n]);
      if (told.alone < 1e-9 * told.largest) told.close = (n + 1) * every * interval;
    }
    return { kind: "checked", ...told, pieces, until: checks * every * interval, took: now() - began };
  }

  const tasks = {
    module({ bytes }) { module = new WebAssembly.Module(bytes); },
    open({ bytes, step, bearing: number }) {
      opened = number;
      running = false;
      content = bytes;
      interval = step;
      bearing = fresh();
      bearing.open(bytes);
      since = 0;
      still({ opened: true });
      post({ kind: "picture", ...picture() });
    },
    turn({ asked }) {
      for (const [handle, value] of asked) bearing.ask(handle, value);
      const anew = bearing.apply();
      // The watched roller changes often, and nothing but its trace.
      if (asked.every(([handle]) => handle === ROLLER)) { post({ kind: "handles", handles: bearing.handles() }); return; }
      if (anew) since = 0;
      still({ anew });
      if (anew) post({ kind: "picture", ...picture() });
    },
    restart() { bearing.sure(bearing.x.lab_restart()); since = 0; still({ anew: true }); },
    run({ on, slow }) { running = on; pace = slow; since = 0; },
    read() { unread -= 1; },
    check({ reference, states }) { post(check(reference, states)); },
  };

  return (message) => {
    try { tasks[message.task](message); } catch (error) {
      // The handles stand where they stood.
      post({ kind: "refused", task: message.task, why: error.message, handles: bearing ? bearing.still().handles : [] });
    }
    schedule();
  };
}
