// Deep links: what the viewer shows, as the part of the address after '#'.

const LINK_KEYS = [
  "model", "setting", "a", "b", "seed", "layer", "from", "move", "colour", "metric", "hide",
  "camera",
];

/** What an address asks the viewer for; null if it means something else, such as a heading. */
function readLink(hash) {
  const text = hash.replace(/^#/, "");
  if (!text.includes("=")) return null;
  const params = new URLSearchParams(text);
  const link = {};
  for (const key of LINK_KEYS) if (params.has(key)) link[key] = params.get(key);
  return link;
}

/** The address that asks for it; keys without a value are left out. */
function writeLink(link) {
  const params = new URLSearchParams();
  for (const key of LINK_KEYS) {
    const value = link[key];
    if (value !== undefined && value !== null && value !== "") params.set(key, value);
  }
  return `#${params}`;
}
