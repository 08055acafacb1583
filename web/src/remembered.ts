// How a user likes the page: colours, widths. Cookies, because the port of the workbench differs from start to start, and cookies do not depend
// on it; the storage of the browser where there are none, as in a file. Every program on this computer can read and write them: they are no
// secrets, and whoever reads one must expect anything.

/** Time for which a cookie is kept. [s] */
const YEAR = 31_536_000;

export function remembered(key: string): string | null {
  try {
    const found = document.cookie.split("; ").find((own) => own.startsWith(`${key}=`));
    if (found) return decodeURIComponent(found.slice(key.length + 1));
  } catch {
    // A page without cookies, or not one of ours.
  }
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

export function remember(key: string, text: string): void {
  try {
    document.cookie = `${key}=${encodeURIComponent(text)}; path=/; max-age=${YEAR}; samesite=strict`;
  } catch {
    // A page without cookies.
  }
  try {
    localStorage.setItem(key, text);
  } catch {
    // A browser without storage forgets it.
  }
}
