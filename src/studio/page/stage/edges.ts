// How smoothly edges are drawn. Without a graphics card smooth edges take three times as long: there the picture has rough ones while
// it changes, and is drawn larger than it is shown when it rests.
import type { WebGLRenderer } from 'three';

const ON_PROCESSOR = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const REST_MS = 250;

export function drawsOnProcessor(): boolean {
  const context = document.createElement('canvas').getContext('webgl2');
  const info = context?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(context!.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return ON_PROCESSOR.test(name);
}

export class Edges {
  private timer: number | undefined;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly slow: boolean,
    private readonly draw: () => void,
  ) {
    this.sharpen(1);
  }

  // Before the picture is drawn because something has changed.
  changed(): void {
    this.sharpen(1);
    if (!this.slow) return;
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      this.sharpen(2);
      this.draw();
    }, REST_MS);
  }

  // Pixels are drawn so many times as finely as they are shown.
  private sharpen(times: number): void {
    const ratio = Math.min(2, times * window.devicePixelRatio);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
  }
}
