// What a reader would stumble over in a page: run in the page, gives lists that should be empty.
(async () => {
  const over = (e) => e.checkVisibility() && e.scrollWidth > e.clientWidth + 1;
  const name = (e) => `${e.tagName} ${(e.textContent || "").trim().slice(0, 40)}`;
  // what is folded may scroll in its frame; what is seen at once is drawn for the screen
  const sideways = [...document.querySelectorAll("figure .wide")].filter(over).map((e) => e.ariaLabel);
  for (const folded of document.querySelectorAll("details")) folded.open = true;
  const cut = [...document.querySelectorAll(".wide")].filter((e) => e.querySelector("table") && over(e)).map(name);
  const channel = (v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  const parse = (colour) => { const c = colour.match(/[\d.]+/g).map(Number); return c.length < 4 ? [...c, 1] : c; };
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const under = (e) => {
    for (; e; e = e.parentElement) {
      const c = parse(getComputedStyle(e).backgroundColor);
      if (c[3] > 0) return c;
    }
    return [255, 255, 255, 1];
  };
  const decodes = async (source) => {
    const image = new Image();
    image.src = source;
    try { await image.decode(); } catch { return false; }
    return image.naturalWidth > 0;
  };
  const sources = [...document.images].map((i) => i.src)
    .concat([...document.querySelectorAll("svg image")].map((i) => i.href.baseVal));
  const broken = [];
  for (const source of sources) if (!(await decodes(source))) broken.push(source.slice(0, 60));

  const ids = [...document.querySelectorAll("[id]")].map((e) => e.id);
  const known = new Set(ids);
  const asked = [...document.documentElement.outerHTML.matchAll(/url\((?:&quot;|")?#([^)"&]+)|href="#([^"]+)"/g)]
    .map((m) => m[1] || m[2]);

  const scrolls = (e) => e.closest(".wide, nav, pre");
  const wide = [...document.body.querySelectorAll("*")]
    .filter((e) => !scrolls(e.parentElement || e) && e.getBoundingClientRect().right > innerWidth + 0.5).map(name);
  if (document.documentElement.scrollWidth > innerWidth) wide.push(`page ${document.documentElement.scrollWidth}`);

  const faint = [], tiny = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const e = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || ["STYLE", "SCRIPT", "METADATA"].includes(e.tagName.toUpperCase())) continue;
    if (!e.checkVisibility()) continue;
    const style = getComputedStyle(e), svg = e.closest("svg text");
    const ink = light(parse(svg ? style.fill : style.color)), paper = light(under(e));
    const contrast = (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    const size = parseFloat(style.fontSize) * (svg ? Math.hypot(svg.getScreenCTM().a, svg.getScreenCTM().b) : 1);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    if (contrast < (large ? 3 : 4.5)) faint.push(`${name(e)}: ${contrast.toFixed(2)}`);
    if (size < (svg ? 9 : 12)) tiny.push(`${name(e)}: ${size.toFixed(1)} px`);
  }
  return {
    broken, wide, faint, tiny, sideways, cut,
    // a phone shows a page that is too wide smaller, by laying out a wider one
    screen: innerWidth,
    doubled: ids.filter((id, i) => ids.indexOf(id) !== i),
    astray: asked.filter((id) => !known.has(id)),
    figures: document.querySelectorAll("figure svg").length,
    paper: light(parse(getComputedStyle(document.body).backgroundColor)),
  };
})()
