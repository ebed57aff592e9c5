#pragma once

namespace planetree::tools {

/// An examination for Browser::visit(): how a page fits the window.
///
/// width, scrollWidth   of the window, and of what is in it
/// isDark               whether the background is darker than the text
/// covered              texts of drawings that cover each other
/// cut                  texts that reach out of their drawing
/// faint                texts and marks whose contrast with the page is below that of WCAG 2.2 AA
inline constexpr const char* kExamineLayout = R"js(
  const light = (colour) => {
    const parts = colour.match(/[\d.]+/g).slice(0, 3).map((part) => {
      const share = part / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
  };
  const contrast = (a, b) =>
    (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
  const page = getComputedStyle(document.body);
  const background = page.backgroundColor;
  const covered = [], cut = [], faint = [];
  for (const svg of document.querySelectorAll('svg.plot')) {
    const frame = svg.getBoundingClientRect();
    const texts = [...svg.querySelectorAll('text')]
      .filter((text) => getComputedStyle(text).display !== 'none')
      .map((text) => ({name: svg.id + ': ' + text.textContent, box: text.getBoundingClientRect()}));
    texts.forEach(({name, box}, i) => {
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 ||
          box.bottom > frame.bottom + 1) cut.push(name);
      for (const other of texts.slice(0, i))
        if (box.left < other.box.right && other.box.left < box.right &&
            box.top + 2 < other.box.bottom && other.box.top + 2 < box.bottom)
          covered.push(name + ' and ' + other.name);
    });
  }
  const judge = (selector, property, least) => {
    for (const element of document.querySelectorAll(selector))
      if (contrast(getComputedStyle(element)[property], background) < least) {
        faint.push(selector);
        return;
      }
  };
  for (const text of ['p', 'dt', 'dd', 'th', 'td', 'figcaption', 'li', 'h1', 'h2', '.purpose'])
    judge(text, 'color', 4.5);
  for (const text of ['svg .tick', 'svg .title', 'svg .label']) judge(text, 'fill', 4.5);
  judge('svg.plot .point', 'color', 3);
  return {
    width: innerWidth, scrollWidth: document.documentElement.scrollWidth,
    isDark: light(background) < light(page.color), covered, cut, faint,
  };
)js";

}  // namespace planetree::tools
