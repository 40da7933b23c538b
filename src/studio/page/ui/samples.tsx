// Small drawings of the samples, so that the empty page needs nothing from the program.
const CHECKER = ['#d8443c', '#f2b632', '#2f7fb5', '#3d9a6b'];

function Mask() {
  return (
    <g>
      <path d="M60 12c22 0 34 15 34 36 0 24-14 48-34 48S26 72 26 48c0-21 12-36 34-36z" fill="#e9c39b" />
      <path d="M34 44c5-6 15-6 20 0-4 7-16 7-20 0zM66 44c5-6 15-6 20 0-4 7-16 7-20 0z" fill="#fff" />
      <circle cx="44" cy="44" r="3.4" fill="#2b4f6e" />
      <circle cx="76" cy="44" r="3.4" fill="#2b4f6e" />
      <path d="M60 46c-1 8-6 14-7 18 2 3 12 3 14 0-1-4-6-10-7-18z" fill="#d9a87b" />
      <path d="M46 76c8-5 20-5 28 0-6 8-22 8-28 0z" fill="#c2413b" />
      <path d="M32 35c6-6 17-6 23-1M65 34c6-5 17-5 23 1" fill="none" stroke="#6b4226" stroke-width="3" stroke-linecap="round" />
      <circle cx="36" cy="62" r="7" fill="#e2937a" opacity=".55" />
      <circle cx="84" cy="62" r="7" fill="#e2937a" opacity=".55" />
    </g>
  );
}

function Ball({ rx, ry }: { rx: number; ry: number }) {
  const id = `ball-${rx}-${ry}`;
  const cells = [];
  for (let row = 0; row < 8; ++row)
    for (let column = 0; column < 8; ++column) {
      const bend = (k: number): number => Math.sin(((k / 8 - 0.5) * Math.PI));
      const [x0, x1] = [60 + rx * bend(column), 60 + rx * bend(column + 1)];
      const [y0, y1] = [54 + ry * bend(row), 54 + ry * bend(row + 1)];
      cells.push(<rect key={`${row} ${column}`} x={x0} y={y0} width={x1 - x0 + 0.4} height={y1 - y0 + 0.4} fill={(row + column) % 2 ? '#f6f4ef' : CHECKER[(row + (column >> 1)) % 4]} />);
    }
  return (
    <g>
      <clipPath id={id}><ellipse cx="60" cy="54" rx={rx} ry={ry} /></clipPath>
      <g clip-path={`url(#${id})`}>{cells}</g>
      <ellipse cx="60" cy="54" rx={rx} ry={ry} fill="url(#shade)" />
    </g>
  );
}

export function SampleDrawing({ name }: { name: string }) {
  return (
    <svg class="drawing" viewBox="0 0 120 108" aria-hidden="true">
      <defs>
        <radialGradient id="shade" cx=".35" cy=".3" r=".8">
          <stop offset="0" stop-color="#fff" stop-opacity=".25" />
          <stop offset=".6" stop-color="#000" stop-opacity="0" />
          <stop offset="1" stop-color="#000" stop-opacity=".35" />
        </radialGradient>
      </defs>
      {name === 'mask' ? <Mask /> : name === 'ellipsoid' ? <Ball rx={48} ry={30} /> : <Ball rx={40} ry={40} />}
    </svg>
  );
}
