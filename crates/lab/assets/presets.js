// What the paper shows, each as a setting of the handles with two sentences. `set` gives handles by name.
import { shown } from "./words.js";

export const PRESETS = [
  {
    id: "noise", name: "Fig. 2: noise", roller: true,
    set: (scene) => ({ ...scene, arcs: 0 }), notch: false, view: "trace",
    words: (f) => `Each time a roller leaves the spall the ring is struck, as often as rollers come by (BPFO, ${shown(f.bpfo, "Hz")}); but between these strikes the signal never rests. `
      + "Circles that a mesh makes of straight facets are not round: what you see there is the mesh, and no bearing has it.",
  },
  {
    id: "facets", name: "Fig. 4: facets", roller: true,
    set: (scene) => ({ ...scene, arcs: 0, facets: Math.max(8, Math.round(0.1875 * scene.facets) * 4) }), notch: false, view: "spectrum",
    words: (f, h) => `A roller of ${h.facets} facets turns ${shown(f.spin, "Hz")} against the cage, so that its corners pass the raceway ${h.facets} × ${f.spin.toFixed(2)} Hz = ${shown(f.facets, "Hz")}: the line with that mark. `
      + "Change the number of facets or the speed, and the line goes with it, while lines of the ring stay where they are.",
  },
  {
    id: "notch", name: "Fig. 6: notch", roller: true,
    set: (scene) => ({ ...scene, arcs: 0 }), notch: true, view: "trace",
    words: (f) => `The paper's remedy is a notch at the tone of ${shown(f.facets, "Hz")}, of quality 15 and without delay: the thick line is what is left, the thin one what was there. `
      + "It takes that one line away and nothing beside it, so the other tones of the mesh stay in the signal.",
  },
  {
    id: "arcs", name: "The cure: arcs", roller: true,
    set: (scene) => ({ ...scene, arcs: 1 }), notch: false, view: "spectrum",
    words: (f, h) => `The same mesh, but rollers and raceways touch as the arcs that their ${h.facets} facets stand for: nothing strikes any more when a corner comes by, and the tone is gone at its source. `
      + "What is left between the strikes of the spall is the bearing: rollers that enter the load and leave it, and the ring that rings.",
  },
  {
    id: "sound-bearing", name: "No spall", roller: true,
    set: (scene) => ({ ...scene, arcs: 1, spallRing: 0 }), notch: false, view: "spectrum",
    words: (f) => `A bearing without a fault still moves its ring, because the rollers that carry the load pass by: ${shown(f.bpfo, "Hz")}, and that is all. `
      + "Put the spall back by its length or its depth, and see from where on the marks of the envelope spectrum stand out.",
  },
];
