// Canvases are drawn at twice the screen resolution at least, so that the page prints sharply.
// Must be imported before the chart library, which reads the ratio when it loads.
const ratio = Math.max(2, window.devicePixelRatio || 1);
Object.defineProperty(window, 'devicePixelRatio', { get: () => ratio });
