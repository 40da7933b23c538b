// For a page before its own scripts: 3D views without smoothed edges, which take a renderer on the processor three times as long.
export function roughEdges() {
  const own = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return own.call(this, kind, kind.startsWith('webgl') ? { ...options, antialias: false } : options);
  };
}
