// Small drawings for buttons; the button's label says what they mean.
const PATHS = {
  undo: 'M6 3 2.5 6.5 6 10M3 6.5h6.5a3.5 3.5 0 0 1 0 7H7',
  redo: 'M10 3l3.5 3.5L10 10M13 6.5H6.5a3.5 3.5 0 0 0 0 7H9',
  play: 'M5 3.2v9.6L12.5 8z',
  pause: 'M5 3.5v9M11 3.5v9',
  turn: 'M13.5 8a5.5 5.5 0 1 1-1.8-4.1M13.8 1.8v3h-3',
  move: 'M8 1.5v13M1.5 8h13M6 3.5l2-2 2 2M6 12.5l2 2 2-2M3.5 6l-2 2 2 2M12.5 6l2 2-2 2',
  face: 'M2 13.5h12M4 10.5 8 3l4 7.5zM8 3v3',
  fit: 'M2 5.5V2h3.5M14 5.5V2h-3.5M2 10.5V14h3.5M14 10.5V14h-3.5M5.5 5.5h5v5h-5z',
  plus: 'M8 3v10M3 8h10',
  trash: 'M3 4.5h10M6 4.5V3h4v1.5M4.5 4.5l.6 8.5h5.8l.6-8.5M6.8 7v3.5M9.2 7v3.5',
  up: 'M4 10l4-4 4 4',
  down: 'M4 6l4 4 4-4',
  right: 'M6 4l4 4-4 4',
  check: 'M3.2 8.4 6.6 12 13 4.6',
  care: 'M8 2.2 14.6 13.6H1.4zM8 6.6v3.2M8 11.4v.6',
  stop: 'M5.3 1.8h5.4l3.5 3.5v5.4l-3.5 3.5H5.3l-3.5-3.5V5.3zM5.6 5.6l4.8 4.8M10.4 5.6l-4.8 4.8',
  lock: 'M4 7.5h8v6H4zM5.5 7.5V5.3a2.5 2.5 0 0 1 5 0v2.2',
  unlock: 'M4 7.5h8v6H4zM5.5 7.5V5.3a2.5 2.5 0 0 1 4.9-.7',
  close: 'M4 4l8 8M12 4l-8 8',
  help: 'M5.8 6a2.2 2.2 0 1 1 3.3 1.9c-.8.5-1.1.9-1.1 1.8M8 11.8v.5',
  file: 'M4 1.8h5l3 3v9.4H4zM9 1.8v3h3',
  picture: 'M2 3h12v10H2zM2 11l3.5-3.5 3 3L11 8l3 3M10.5 5.7h.1',
  text: 'M3 4V3h10v1M8 3v10M6 13h4',
  pattern: 'M2 2h5v5H2zM9 9h5v5H9zM9 4.5h5M11.5 2v5M2 11.5h5M4.5 9v5',
  download: 'M8 2v8M4.8 7 8 10.2 11.2 7M2.5 13.5h11',
  swap: 'M3 5.5h9M9.5 3 12 5.5 9.5 8M13 10.5H4M6.5 8 4 10.5 6.5 13',
  wrench: 'M13.6 4.2a3.4 3.4 0 0 1-4.6 4L4.6 12.8a1.4 1.4 0 0 1-2-2L7 6.4a3.4 3.4 0 0 1 4.2-4.5L9.3 4l.5 2 2 .5z',
  eye: 'M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6.2a1.8 1.8 0 1 1 0 3.6 1.8 1.8 0 0 1 0-3.6z',
  home: 'M2.5 7.5 8 2.5l5.5 5M4 6.5v7h8v-7',
  reload: 'M13.5 8a5.5 5.5 0 1 1-1.8-4.1M13.8 1.8v3h-3',
};

export type IconName = keyof typeof PATHS;

export function Icon({ name, size = 16 }: { name: IconName; size?: number }) {
  return (
    <svg class="icon" width={size} height={size} viewBox="0 0 16 16" aria-hidden="true">
      <path d={PATHS[name]} />
    </svg>
  );
}
