// Form fields. A number's text is the user's while it is being typed: it never jumps, and counts when it is
// left or Enter is pressed; the arrow keys count at once. What cannot count is told, and gone when the field is left.
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useRef } from 'preact/hooks';
import { readOnly } from '../studio.ts';
import { t } from '../strings.ts';
import { Icon, type IconName } from './icons.tsx';

const shown = (value: number): string => String(+value.toFixed(3));

interface NumberProps {
  label: string;
  value: number | null;
  unit?: string;
  min?: number;
  max?: number;
  step?: number;
  empty?: string; // what no number means
  tooMuch?: string; // in place of the plain limit
  hint?: string;
  unitElsewhere?: boolean; // it is shown with what several fields are about
  name?: string;
  inline?: boolean;
  disabled?: boolean;
  onChange: (value: number | null, live: boolean) => void;
}

// In the field's unit, that may stand there, or a length in another; undefined: no number.
function numberIn(text: string, unit: string | undefined): number | undefined {
  const [, figures = '', given = ''] = text.trim().match(/^([-+]?[\d.,]+(?:e[-+]?\d+)?)\s*(\D*)$/i) ?? [];
  const number = Number(figures.replace(',', '.') || NaN);
  if (!Number.isFinite(number)) return undefined;
  const of = given.toLowerCase();
  if (of === '' || of === unit?.toLowerCase() || (unit === '°' && of === 'deg')) return number;
  const [from, to] = [LENGTHS_MM[of], LENGTHS_MM[unit ?? '']];
  return from && to ? Math.round((number * from * 1000) / to) / 1000 : undefined;
}

const LENGTHS_MM: Record<string, number> = { mm: 1, cm: 10, m: 1000, in: 25.4, '"': 25.4, '″': 25.4 };

export function NumberField({ label, value, unit, min, max, step = 1, empty, tooMuch, hint, unitElsewhere, name, inline, disabled, onChange }: NumberProps) {
  const id = useId();
  const typed = useSignal<string | null>(null);
  const why = useSignal(''); // what is typed cannot count
  const stepping = useSignal(false);
  const held = value === null ? '' : shown(value);
  const limited = (number: number): number => Math.min(max ?? Infinity, Math.max(min ?? -Infinity, number));
  const read = (text: string): number | null | undefined => {
    if (text.trim() === '') return empty === undefined ? undefined : null;
    return numberIn(text, unit);
  };
  const fault = (text: string): string => {
    const number = read(text);
    if (number === undefined) return t.fields.number(unit);
    if (number === null || number === limited(number)) return '';
    if (number < limited(number)) return t.fields.atLeast(shown(min!), unit);
    return tooMuch ?? t.fields.atMost(shown(max!), unit);
  };
  const forget = (): void => {
    typed.value = null;
    why.value = '';
  };
  const settle = (): void => {
    stepping.value = false;
    if (typed.value === null || (why.value = fault(typed.value))) return;
    const number = read(typed.value);
    forget();
    if (number !== undefined) onChange(number, false);
  };
  const leave = (): void => {
    settle();
    forget();
  };
  const type = (text: string): void => {
    typed.value = text;
    why.value = fault(text);
  };
  const nudge = (by: number): void => {
    const from = read(typed.value ?? held) ?? 0;
    const next = limited(Math.round((from + by) * 1000) / 1000);
    typed.value = shown(next);
    why.value = '';
    stepping.value = true;
    onChange(next, true);
  };
  // "whole mm" says nothing.
  const wordy = (typed.value ?? held) === '' && empty !== undefined && !Number.isFinite(Number(empty));
  const shownUnit = wordy || unitElsewhere ? undefined : unit;
  return (
    <div class={inline ? 'field inline' : 'field'}>
      <label for={id} title={hint}>{label}</label>
      <span class={shownUnit ? 'entry' : 'entry unitless'}>
        <input
          id={id}
          name={name}
          type="text"
          inputMode="decimal"
          autocomplete="off"
          spellcheck={false}
          disabled={disabled || readOnly.value}
          placeholder={empty}
          value={typed.value ?? held}
          aria-invalid={why.value !== ''}
          aria-describedby={why.value ? `${id}-why` : undefined}
          onInput={(event) => type(event.currentTarget.value)}
          onBlur={leave}
          onKeyDown={(event) => {
            if (event.key === 'Enter') settle();
            else if (event.key === 'Escape' && typed.value !== null) {
              forget();
              event.stopPropagation();
            } else if (event.key === 'ArrowUp' || event.key === 'ArrowDown') {
              event.preventDefault();
              nudge((event.key === 'ArrowUp' ? step : -step) * (event.shiftKey ? 10 : 1));
            }
          }}
          onKeyUp={(event) => {
            if (stepping.value && (event.key === 'ArrowUp' || event.key === 'ArrowDown')) settle();
          }}
        />
        {shownUnit && <span class="unit" aria-hidden="true">{shownUnit}</span>}
      </span>
      {why.value && <span class="why" id={`${id}-why`} role="alert">{why.value}</span>}
    </div>
  );
}

const AXES = ['x', 'y', 'z'] as const;

interface AxisProps<Values extends number[]> extends Pick<NumberProps, 'unit' | 'unitElsewhere' | 'min' | 'max' | 'step' | 'disabled'> {
  legend: string;
  name: string; // of the fields, with -x, -y and -z behind it
  values: Values; // along x, y and so on
  count?: 2 | 3; // of the values; all of them
  unset?: boolean; // the values stand for nothing yet
  onChange: (values: Values, live: boolean) => void;
  onEmptied?: () => void;
}

export function AxisFields<Values extends number[]>({ legend, name, values, count, unset, onChange, onEmptied, ...field }: AxisProps<Values>) {
  const axes = AXES.slice(0, count ?? values.length);
  return (
    <fieldset class={axes.length === 2 ? 'triple two' : 'triple'}>
      <legend>{legend}</legend>
      {axes.map((axis, k) => (
        <NumberField
          key={axis}
          inline
          name={`${name}-${axis}`}
          label={axis}
          empty={onEmptied && '–'}
          value={unset ? null : values[k]!}
          onChange={(next, live) => (next === null ? onEmptied?.() : onChange(values.map((old, i) => (i === k ? next : old)) as Values, live))}
          {...field}
        />
      ))}
    </fieldset>
  );
}

interface SelectProps {
  label: string;
  value: string;
  options: readonly (readonly [value: string, text: string])[];
  name?: string;
  hideLabel?: boolean;
  always?: boolean; // of the view, so usable where nothing may be changed
  barred?: Record<string, string>; // what cannot be chosen, and why
  onChange: (value: string) => void;
}

export function SelectField({ label, value, options, name, hideLabel, always, barred = {}, onChange }: SelectProps) {
  const id = useId();
  return (
    <div class={hideLabel ? 'field bare' : 'field'}>
      <label for={id} class={hideLabel ? 'hidden' : ''}>{label}</label>
      <select id={id} name={name} disabled={!always && readOnly.value} value={value} onChange={(event) => {
        const chosen = event.currentTarget.value;
        event.currentTarget.value = value; // until what is shown says otherwise: a command can be chosen twice
        onChange(chosen);
      }}>
        {options.map(([key, text]) => <option key={key} value={key} disabled={key in barred} title={barred[key]}>{text}</option>)}
      </select>
    </div>
  );
}

const PAUSE_MS = 250;

interface TextProps {
  label: string;
  value: string;
  name?: string;
  rows?: number;
  live?: boolean; // shown as it is typed, after a short pause
  onChange: (value: string, live: boolean) => void;
}

export function TextField({ label, value, name, rows, live, onChange }: TextProps) {
  const id = useId();
  const typed = useSignal<string | null>(null);
  const pause = useRef(0);
  const settle = (): void => {
    clearTimeout(pause.current);
    if (typed.value === null) return;
    const text = typed.value;
    typed.value = null;
    onChange(text, false);
  };
  const type = (text: string): void => {
    typed.value = text;
    clearTimeout(pause.current);
    if (live) pause.current = window.setTimeout(() => latest.current.onChange(text, true), PAUSE_MS);
  };
  // What was typed counts too where the field goes away with it.
  const latest = useRef({ settle, onChange });
  latest.current = { settle, onChange };
  useEffect(() => () => latest.current.settle(), []);
  const common = { id, name, disabled: readOnly.value, value: typed.value ?? value, onBlur: settle };
  return (
    <div class="field">
      <label for={id}>{label}</label>
      {rows ? (
        <textarea {...common} rows={rows} onInput={(event) => type(event.currentTarget.value)} />
      ) : (
        <input
          {...common}
          type="text"
          onInput={(event) => type(event.currentTarget.value)}
          onKeyDown={(event) => event.key === 'Enter' && settle()}
        />
      )}
    </div>
  );
}

export function ColorField({ label, value, name, onChange }: { label: string; value: string; name?: string; onChange: (value: string, live: boolean) => void }) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <input
        id={id}
        name={name}
        type="color"
        disabled={readOnly.value}
        value={value}
        onInput={(event) => onChange(event.currentTarget.value, true)}
        onChange={(event) => onChange(event.currentTarget.value, false)}
      />
    </div>
  );
}

export function CheckField({ label, checked, name, always, onChange }: { label: string; checked: boolean; name?: string; always?: boolean; onChange: (checked: boolean) => void }) {
  return (
    <label class="check">
      <input type="checkbox" name={name} disabled={!always && readOnly.value} checked={checked} onChange={(event) => onChange(event.currentTarget.checked)} />
      <span>{label}</span>
    </label>
  );
}

interface ButtonProps {
  label: string; // for the eye and the ear
  spoken?: string; // for the ear, where the eye sees more than the label
  icon?: IconName;
  iconOnly?: boolean;
  kind?: 'main' | 'mend' | 'plain' | 'quiet';
  pressed?: boolean;
  disabled?: boolean;
  changes?: boolean; // the job: not where it may only be looked at
  title?: string;
  name?: string;
  expanded?: boolean;
  onClick: () => void;
  children?: ComponentChildren;
}

export function Button({ label, spoken, icon, iconOnly, kind = 'plain', pressed, disabled, changes, title, name, expanded, onClick, children }: ButtonProps) {
  return (
    <button
      type="button"
      class={`button ${kind}${iconOnly ? ' icon-only' : ''}`}
      aria-pressed={pressed}
      aria-expanded={expanded}
      aria-label={iconOnly ? label : spoken}
      title={title ?? (iconOnly ? label : undefined)}
      data-name={name}
      disabled={disabled || (changes && readOnly.value)}
      onClick={onClick}
    >
      {icon && <Icon name={icon} />}
      {!iconOnly && <span>{label}</span>}
      {children}
    </button>
  );
}

// A choice of a few, side by side.
interface SegmentsProps<T extends string> {
  label: string;
  value: T;
  options: readonly (readonly [T, string])[];
  always?: boolean;
  onChange: (value: T) => void;
}

export function Segments<T extends string>({ label, value, options, always, onChange }: SegmentsProps<T>) {
  return (
    <div class="segments" role="group" aria-label={label}>
      {options.map(([key, text]) => (
        <button key={key} type="button" aria-pressed={key === value} data-value={key} disabled={!always && readOnly.value} onClick={() => onChange(key)}>{text}</button>
      ))}
    </div>
  );
}

export function SegmentsField<T extends string>(props: SegmentsProps<T>) {
  return (
    <div class="field">
      <span class="label" aria-hidden="true">{props.label}</span>
      <Segments {...props} />
    </div>
  );
}

interface FilesProps {
  label: string;
  icon?: IconName;
  kind?: 'main' | 'plain';
  accept?: string;
  many?: boolean;
  name?: string;
  disabled?: boolean;
  title?: string;
  onFiles: (files: File[]) => void;
}

export function Files({ label, icon, kind, accept, many, name, disabled, title, onFiles }: FilesProps) {
  const id = useId();
  const off = disabled || readOnly.value;
  return (
    <span class="files" title={title}>
      <input
        id={id}
        class="hidden"
        type="file"
        name={name}
        accept={accept}
        multiple={many}
        disabled={off}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = '';
          onFiles(files);
        }}
      />
      <label for={id} class={`button ${kind ?? 'plain'}${off ? ' off' : ''}`}>
        {icon && <Icon name={icon} />}
        <span>{label}</span>
      </label>
    </span>
  );
}

export function Group({ title, children }: { title?: string; children: ComponentChildren }) {
  return (
    <section class="group">
      {title && <h3>{title}</h3>}
      {children}
    </section>
  );
}
