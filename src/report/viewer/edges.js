// How smoothly edges are drawn, here and in the studio. Without a graphics card smooth edges take three times as long: there the picture
// has rough ones while it changes, and is drawn larger than it is shown when it rests.

const ON_PROCESSOR = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const REST_MS = 250;
const LOOK_MS = 20;

export function drawsOnProcessor() {
  const context = document.createElement('canvas').getContext('webgl2');
  const info = context?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return ON_PROCESSOR.test(name);
}

// Of a THREE.WebGLRenderer; `slow`: it draws on the processor, without smoothing; `draw` draws whatever there is to see.
export class Edges {
  constructor(renderer, slow, draw) {
    this.renderer = renderer;
    this.slow = slow;
    this.draw = draw;
    this.timer = 0;
    this.drawn = null; // a fence behind the last picture's commands
    this.sharpen(1);
  }

  // Draws because something has changed.
  show() {
    this.sharpen(1);
    this.draw();
    if (this.slow) this.waitForRest();
  }

  // Rest begins when the picture is there, not when it was asked for: large objects take longer to draw than people pause.
  waitForRest() {
    const gl = this.renderer.getContext();
    if (this.drawn) gl.deleteSync(this.drawn);
    this.drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    window.clearTimeout(this.timer);
    const look = () => {
      if (gl.isContextLost()) return;
      const isThere = gl.getSyncParameter(this.drawn, gl.SYNC_STATUS) === gl.SIGNALED;
      this.timer = isThere ? window.setTimeout(() => this.rest(), REST_MS) : window.setTimeout(look, LOOK_MS);
    };
    look();
  }

  rest() {
    this.sharpen(2);
    this.draw();
  }

  // Pixels are drawn so many times as finely as they are shown.
  sharpen(times) {
    const ratio = Math.min(2, times * window.devicePixelRatio);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
  }
}
