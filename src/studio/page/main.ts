import { h, render } from 'preact';
import { begin, failure } from './studio.ts';
import { App } from './ui/app.tsx';

render(h(App, {}), document.getElementById('studio')!);
begin().catch((error: unknown) => {
  failure.value = error instanceof Error ? error.message : String(error);
});
