// What the paper shows, each as a setting of the handles with two sentences. `set` gives handles by name.
import { shown } from "./words.js";

// The rate at which rollers pass the spall, by its name.
const passing = (f, h) => (h.spallRing > 1 ? `BPFI, ${shown(f.bpfi, "Hz")}` : `BPFO, ${shown(f.bpfo, "Hz")}`);

export const PRESETS = [
  {
    id: "noise", name: "Noise", roller: true,
    set: (scene) => ({ ...scene, arcs: 0 }), notch: false, view: "trace",
    words: (f, h) => `Whenever a roller leaves the spall it strikes the ring (${passing(f, h)}), and between two strikes a real bearing would be nearly quiet. `
      + "This one never is: its circles are meshed with straight facets, and a polygon that rolls over a polygon strikes at every corner (Singh et al. 2014, Fig. 2).",
  },
  {
    id: "facets", name: "Facets", roller: true,
    set: (scene) => ({ ...scene, arcs: 0, facets: Math.max(8, Math.round(0.1875 * scene.facets) * 4) }), notch: false, view: "spectrum",
    words: (f, h) => `A roller with ${h.facets} facets turns about itself at ${f.spin.toFixed(2)} Hz, so its corners pass the raceway at ${h.facets} × ${f.spin.toFixed(2)} Hz = ${shown(f.facets, "Hz")}: the tone at the red mark of the spectrum. `
      + "Change the facets or the speed and the tone moves with them; the resonances of the ring stay where they are.",
  },
  {
    id: "notch", name: "Notch", roller: true,
    set: (scene) => ({ ...scene, arcs: 0 }), notch: true, view: "trace",
    words: (f) => `The remedy of Singh et al. (2014, Fig. 6) is a notch filter at the tone of ${shown(f.facets, "Hz")}, of quality 15 and without delay: in the uppermost plot the thin line is the signal, the thick one what the filter leaves. `
      + "It removes that tone alone; its multiples and all else that facets do stay in the signal.",
  },
  {
    id: "arcs", name: "The cure: arcs", roller: true,
    set: (scene) => ({ ...scene, arcs: 1 }), notch: false, view: "spectrum",
    words: (f, h) => `Here rollers and raceways touch as the arcs that the same ${h.facets} facets stand for: no corners pass, nothing strikes, and the tone is gone at its source. `
      + "What is left between the strikes of the spall is the bearing itself: rollers that take up load and give it back, and the ring that rings.",
  },
  {
    id: "sound-bearing", name: "No spall", roller: true,
    set: (scene) => ({ ...scene, arcs: 1, spallRing: 0 }), notch: false, view: "spectrum",
    words: (f) => `A bearing without a fault moves its ring all the same, because rollers come under the load and leave it (BPFO, ${shown(f.bpfo, "Hz")}); that is all there is. `
      + "Choose a ring under “Spall” to put one back, and the marks of the envelope spectrum stand out.",
  },
];
