#include "tools/html/page_style.h"

namespace planetree::tools {

// Texts of drawings are in units of the drawing, which is 480 wide. It is scaled down on narrow
// pages, so its text is larger there; see the sizes in plot_layout.cpp.
const char* const kPageStyle = R"css(
:root {
  --page: #ffffff; --raised: #ffffff; --band: #f3f5f7; --text: #1c2128; --quiet: #57606a;
  --line: #d5dae0; --grid: #e6e9ed; --c0: #0b62c4; --c1: #b04a00; --c2: #167246;
  --c3: #8a3ab9; --c4: #b3205a; --c5: #75590a;
  --muted: #8b939c; --lit: #fff3c4; --shadow: 0 2px 10px rgb(0 0 0 / 18%);
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #15181c; --raised: #22272e; --band: #1d2126; --text: #e4e8ec; --quiet: #a1abb6;
    --line: #3d444d; --grid: #2a2f36; --c0: #6cb2ff; --c1: #f2a15a; --c2: #62cf93;
    --c3: #c99bf0; --c4: #f58ab0; --c5: #d8c05a;
    --muted: #7d8690; --lit: #4a3f12; --shadow: 0 2px 12px rgb(0 0 0 / 60%);
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--page); color: var(--text);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
}
main { max-width: 1340px; margin: 0 auto; padding: 28px 24px 56px; }
header { margin-bottom: 18px; }
.kind { margin: 0; color: var(--quiet); font-size: 14px; }
h1 { margin: 0; font-size: 28px; line-height: 1.25; overflow-wrap: anywhere; }
h2 { margin: 0 0 6px; font-size: 20px; line-height: 1.3; }
section { margin-top: 40px; padding-top: 24px; border-top: 1px solid var(--line); }
p { margin: 0 0 12px; max-width: 78ch; overflow-wrap: anywhere; }
.facts { display: flex; flex-wrap: wrap; gap: 10px 36px; margin: 0 0 16px; }
.facts dt { color: var(--quiet); font-size: 13px; }
.facts div { min-width: 0; }
.facts dd { margin: 0; overflow-wrap: anywhere; font-size: 17px; font-variant-numeric: tabular-nums; }
.plots { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 20px 40px; }
.plots > div { min-width: 0; }
figure { margin: 10px 0 4px; min-width: 0; max-width: 640px; }
figcaption { font-weight: 600; }
.legend {
  display: flex; flex-wrap: wrap; gap: 2px 16px; margin: 2px 0 6px; padding: 0;
  list-style: none; color: var(--quiet); font-size: 13px;
}
.legend li { display: flex; align-items: center; gap: 5px; }
.key { width: 14px; height: 14px; flex: none; overflow: visible; }
.canvas { position: relative; }
svg.plot { display: block; width: 100%; height: auto; touch-action: pan-y; border-radius: 4px; }
svg.plot:focus { outline: none; }
svg.plot:focus-visible { outline: 2px solid var(--c0); outline-offset: 2px; }
svg text { font: 11px system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; }
.tick, .title { fill: var(--quiet); }
.tick { font-variant-numeric: tabular-nums; }
.label {
  fill: var(--text); paint-order: stroke; stroke: var(--page); stroke-width: 3px;
  stroke-linejoin: round; pointer-events: none;
}
.grid { stroke: var(--grid); fill: none; }
.frame, .mark { stroke: var(--muted); fill: none; }
.lane { fill: var(--band); }
.line { fill: none; stroke: currentColor; stroke-width: 1.4; stroke-opacity: 0.6; }
.cell { fill: currentColor; }
.dashed { stroke-dasharray: 4 3; }
.steps { fill: none; stroke: var(--quiet); stroke-width: 1.3; stroke-opacity: 0.55; }
.point, .line, .cell { color: var(--c0); }
.point.c1, .line.c1 { color: var(--c1); }
.point.c2, .line.c2 { color: var(--c2); }
.point.c3, .line.c3 { color: var(--c3); }
.point.c4, .line.c4 { color: var(--c4); }
.point.c5, .line.c5 { color: var(--c5); }
.point.note { color: var(--quiet); }
.point.muted { color: var(--muted); }
.shape { fill: currentColor; stroke: var(--page); stroke-width: 1.2; }
.point .column { stroke: none; }
.point .hit { fill: none; }
.hollow .shape { fill: var(--page); stroke: currentColor; stroke-width: 1.8; }
.stem { stroke: currentColor; stroke-width: 1.6; stroke-opacity: 0.55; fill: none; }
.point.lit .shape { stroke: var(--text); stroke-width: 2.4; }
.point.lit .column { stroke: var(--text); stroke-width: 1.4; }
.tip {
  position: absolute; display: none; z-index: 2; width: max-content; max-width: 100%;
  padding: 9px 12px; background: var(--raised); color: var(--text); pointer-events: none;
  border: 1px solid var(--line); border-radius: 6px; box-shadow: var(--shadow); font-size: 13px;
  line-height: 1.4;
}
.tip.shown { display: block; }
.tip strong { display: block; margin-bottom: 3px; font-size: 14px; }
.tip dl { columns: 2; column-gap: 24px; margin: 0; }
.tip dl div { display: flex; justify-content: space-between; gap: 12px; break-inside: avoid; }
.tip dt { color: var(--quiet); }
.tip dd { margin: 0; text-align: right; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
.scroll { overflow-x: auto; border-radius: 4px; }
.tall { max-height: 25em; width: fit-content; max-width: 100%; overflow-y: auto; border-bottom: 1px solid var(--line); }
.tall thead { position: sticky; top: 0; z-index: 1; background: var(--page); }
.scroll:focus-visible, .command:focus-visible { outline: 2px solid var(--c0); outline-offset: 2px; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; }
.caption { max-width: none; color: var(--quiet); font-size: 13.5px; margin: 14px 0 6px; }
th, td { padding: 3px 10px; white-space: nowrap; text-align: right; }
thead th { color: var(--quiet); font-weight: 500; vertical-align: bottom; }
thead tr:last-child th, thead th[rowspan] { border-bottom: 1px solid var(--line); }
th.group { text-align: center; padding-bottom: 1px; }
th.group span { display: block; border-bottom: 1px solid var(--line); }
th.text, td.text, th.code, td.code { text-align: left; }
th:first-child, tbody th { text-align: left; padding-left: 8px; }
thead tr:nth-child(2) th:first-child { text-align: right; }
tbody th { font-weight: 600; position: sticky; left: 0; background: var(--page); }
tbody tr:nth-child(even) > * { background: var(--band); }
tbody tr.muted > *, tbody tr.muted code { color: var(--quiet); font-weight: 400; }
tbody tr.lit > * { background: var(--lit); }
code { font: 12.5px ui-monospace, "SF Mono", "DejaVu Sans Mono", monospace; }
.purpose { margin: 16px 0 4px; color: var(--quiet); }
.command {
  margin: 0; padding: 10px 14px; background: var(--band); border-radius: 6px; overflow-x: auto;
}
.command code { user-select: all; }
.unseen {
  position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%);
}
@media (max-width: 900px) {
  .plots { grid-template-columns: minmax(0, 1fr); }
}
@media (min-width: 901px) {
  thead th { white-space: normal; }
}
@media (max-width: 560px) {
  .tip dl { columns: 1; }
  main { padding: 18px 14px 40px; }
  h1 { font-size: 23px; }
  svg text { font-size: 15px; }
  svg .extra { display: none; }
  th, td { padding: 3px 9px; }
}
@media print {
  .scroll { overflow: visible; }
  .tall { max-height: none; }
  section { break-inside: avoid; }
}
)css";

}  // namespace planetree::tools
