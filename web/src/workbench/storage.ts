// Values that the browser keeps: how the user likes the page, or in the storage of a tab what it shows. A browser without storage forgets them.

import { remember, remembered } from "../remembered.ts";

/** The value, or `otherwise` if there is none of its type. */
export function stored<T>(key: string, otherwise: T, storage?: Storage): T {
  try {
    const text = storage ? storage.getItem(key) : remembered(key);
    const value: unknown = text === null ? null : JSON.parse(text);
    return value !== null && typeof value === typeof otherwise ? (value as T) : otherwise;
  } catch {
    return otherwise;
  }
}

export function store(key: string, value: unknown, storage?: Storage): void {
  try {
    if (storage) storage.setItem(key, JSON.stringify(value));
    else remember(key, JSON.stringify(value));
  } catch {
    // Forgotten.
  }
}
