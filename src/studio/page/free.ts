// The part of the middle of the window that an open panel leaves free, for what the panel is about.

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

// From the middle's four sides.
export interface Insets {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const NONE: Insets = { left: 0, top: 0, right: 0, bottom: 0 };
const LEAST = 240; // px: in less than that nothing is to be seen
const GAP = 8;

// Beside, below or above `panel`, whichever has most room; all of `middle` where nothing is covered, or all that matters.
export function freePart(middle: Box, panel: Box | null): Insets {
  if (!panel || panel.left >= middle.right || panel.right <= middle.left || panel.top >= middle.bottom || panel.bottom <= middle.top) return NONE;
  const [width, height] = [middle.right - middle.left, middle.bottom - middle.top];
  const sides = [
    { ...NONE, right: middle.right - panel.left + GAP },
    { ...NONE, left: panel.right - middle.left + GAP },
    { ...NONE, top: panel.bottom - middle.top + GAP },
    { ...NONE, bottom: middle.bottom - panel.top + GAP },
  ];
  const room = ({ left, right, top, bottom }: Insets): number => Math.min(width - left - right, height - top - bottom);
  const best = sides.reduce((a, b) => (room(b) > room(a) ? b : a));
  return room(best) < LEAST ? NONE : best;
}
