// For a page before its own scripts: 3D views without smoothed edges, which take a renderer on the processor three times as long, and
// without a name by which a page could know it as one.
export function roughEdges() {
  const own = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return own.call(this, kind, kind.startsWith('webgl') ? { ...options, antialias: false } : options);
  };
  const extension = WebGL2RenderingContext.prototype.getExtension;
  WebGL2RenderingContext.prototype.getExtension = function (name) {
    return name === 'WEBGL_debug_renderer_info' ? null : extension.call(this, name);
  };
}
