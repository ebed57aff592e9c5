// The shape of the surface as the server sends it: discs, and triangles where it is finest.

const kHeadWords = 8;
const kDiscWords = 16, kTriangleWords = 12;
const kSteps = [3000, 20000, 100000];
const kSlowMs = 250;  // a shape that takes longer to draw is not made finer

// Reads the bytes; tools/view/README.md describes them.
function parse(buffer) {
  const [discs, triangles, complete, , deepest] = new Uint32Array(buffer, 0, kHeadWords);
  const floats = new Float32Array(buffer, 4 * kHeadWords);
  return {
    discs, triangles, complete: complete !== 0, deepest: Math.max(1, deepest),
    discData: floats.subarray(0, discs * kDiscWords),
    triangleData: floats.subarray(discs * kDiscWords, discs * kDiscWords + triangles * kTriangleWords),
  };
}

export class ShapeLoader {
  // onShape(shape): called with finer and finer shapes; returns a promise of the milliseconds that
  // it takes to draw it
  constructor(onShape) {
    this.onShape = onShape;
    this.steps = kSteps;
    this.abort = null;
    this.shown = 0;
  }

  // Loads the shape as it is seen from an eye: {eye, look, cosine}, see ShapeView.
  async load({eye, look, cosine}) {
    this.abort?.abort();
    const abort = this.abort = new AbortController();
    const seen = `x=${eye[0]}&y=${eye[1]}&z=${eye[2]}&dx=${look[0]}&dy=${look[1]}&dz=${look[2]}&cosine=${cosine}`;
    try {
      for (const discs of this.steps)
        for (let complete = false; !complete;) {
          const reply = await fetch(`shape?discs=${discs}&${seen}`, {signal: abort.signal});
          if (!reply.ok) throw new Error(await reply.text());
          const shape = parse(await reply.arrayBuffer());
          if (abort.signal.aborted) return;
          complete = shape.complete;
          // A coarser picture than before would flicker.
          const size = shape.discs + shape.triangles;
          if (!complete && size < this.shown) continue;
          this.shown = size;
          const isSlow = await this.onShape(shape) > kSlowMs;
          if (abort.signal.aborted) return;
          if (isSlow) this.steps = [discs];
          if (isSlow && complete) return;
        }
      this.steps = this.steps.slice(-1);
    } catch (error) {
      if (!abort.signal.aborted) throw error;
    }
  }
}
