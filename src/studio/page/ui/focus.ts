// Where the keyboard goes when what it was in comes or goes.
import { useLayoutEffect, useRef } from 'preact/hooks';

// The first that is there and usable, once what was changed is shown.
export function focusOn(...selectors: string[]): void {
  requestAnimationFrame(() => {
    for (const selector of selectors) {
      const element = document.querySelector<HTMLElement>(selector);
      if (!element || element.matches(':disabled')) continue;
      element.focus();
      if (element.matches('input[type="text"], textarea')) (element as HTMLInputElement).select();
      return;
    }
  });
}

// As that, where the focus went with what had it.
export function focusIfLost(...selectors: string[]): void {
  requestAnimationFrame(() => {
    if (!document.activeElement || document.activeElement === document.body) focusOn(...selectors);
  });
}

// A panel takes the focus when it opens: its first field, or itself, so that it is read and scrolled. When it closes with
// the focus in it, that goes back to where it was, else to the button that opens the panel.
export function usePanelFocus(button: string) {
  const panel = useRef<HTMLElement>(null);
  useLayoutEffect(() => {
    const own = panel.current!;
    const before = document.activeElement;
    const field = own.querySelector<HTMLInputElement>('input');
    (field ?? own).focus();
    field?.select();
    return () => {
      if (!own.contains(document.activeElement) && document.activeElement !== document.body) return;
      if (before instanceof HTMLElement && before.isConnected && before !== document.body) before.focus();
      else document.querySelector<HTMLElement>(button)?.focus();
    };
  }, []);
  return panel;
}

// What is left behind with the focus in it hands it on.
export function useFocusHandedTo(selector: () => string) {
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const own = box.current!;
    return () => {
      if (own.contains(document.activeElement)) document.querySelector<HTMLElement>(selector())?.focus();
    };
  }, []);
  return box;
}

export const takeFocus = (element: HTMLElement | null): void => element?.focus();
