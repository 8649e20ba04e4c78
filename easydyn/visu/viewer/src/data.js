// What the report hands over: JSON with arrays as base64 of little-endian float32.

export function pageData() {
  return JSON.parse(document.getElementById('page-data').textContent);
}

export function floats(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

const superscript = (n) => String(n).replace(/./g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]));
const minus = (text) => text.replace('-', '−');

// A number as an engineer writes it: at most `digits` significant ones, powers of ten where zeros would pile up.
export function numberText(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    const factor = String(Number(mantissa));
    const power = `10${superscript(Number(exponent))}`;
    return minus(factor === '1' ? power : factor === '-1' ? `-${power}` : `${factor}·${power}`);
  }
  return minus(String(Number(value.toPrecision(digits))));
}

export function axisTitle(axis) {
  return axis.unit ? `${axis.label} [${axis.unit}]` : axis.label;
}
