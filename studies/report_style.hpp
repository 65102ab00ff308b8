// The style that the report's sections share: one column, tables with aligned figures, colours of the theme.
#pragma once

#include <string_view>

namespace bedload {

inline constexpr std::string_view report_style = R"css(
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.55 system-ui, -apple-system, "Segoe UI", "Liberation Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1020px; margin: 0 auto; padding: 28px 24px 64px; }
header h1 { font-size: 27px; margin: 0 0 2px; letter-spacing: -0.01em; }
header p { margin: 0; color: var(--soft); }
section { background: var(--paper); border: 1px solid var(--border); border-radius: 8px; padding: 18px 24px 20px; margin-top: 20px; }
h2 { font-size: 18px; margin: 0 0 4px; }
h3 { font-size: 14px; margin: 14px 0 4px; }
p.moment { margin: 0 0 4px; font-size: 13.5px; color: var(--soft); }
sub { line-height: 0; }
p.caption { margin: 0 0 12px; color: var(--soft); font-size: 13.5px; max-width: 92ch; }
.row { display: flex; flex-wrap: wrap; gap: 8px 22px; } .row > div { min-width: 0; max-width: 100%; }
.scroll { overflow-x: auto; }
svg { display: block; max-width: 100%; height: auto; font-size: 12px; font-family: inherit; fill: var(--text); }
svg .grid { stroke: var(--grid); stroke-width: 1; } svg .fine { stroke: var(--fine); stroke-width: 1; }
svg .frame { fill: none; stroke: var(--frame); } svg .axis { font-size: 13px; fill: var(--ink); }
svg .heading { font-weight: 600; fill: var(--ink); } svg .note { font-size: 12px; } svg.bed { font-size: 14px; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; width: 100%; }
th { text-align: left; font-weight: 600; color: var(--soft); border-bottom: 1px solid var(--rule); padding: 4px 14px 4px 0; vertical-align: bottom; }
td { border-bottom: 1px solid var(--row); padding: 4px 14px 4px 0; vertical-align: top; }
td.n, th.n { text-align: right; } td.n { white-space: nowrap; }
.tag { display: inline-block; white-space: nowrap; border-radius: 4px; padding: 0 7px; font-size: 12.5px; background: var(--tag); color: var(--tag-text); }
.tag.good { background: var(--good); color: var(--good-text); } .tag.open { background: var(--open); color: var(--open-text); }
code, pre { font-family: ui-monospace, "Liberation Mono", "DejaVu Sans Mono", monospace; font-size: 13px; }
pre { background: var(--page); border: 1px solid var(--border); border-radius: 6px; padding: 9px 12px; margin: 6px 0 10px; overflow-x: auto; }
td code { word-break: break-all; font-size: 12px; color: var(--soft); }
@media (max-width: 640px) {
  main { padding: 12px 8px 32px; } section { padding: 14px 12px 16px; border-radius: 6px; }
  header { padding: 0 4px; } td code { word-break: normal; }
}
@media print {
  body { background: none; font-size: 10pt; } main { max-width: none; padding: 0; } section { border: 0; padding: 0; }
  .scroll { overflow: visible; } svg { min-width: 0 !important; } table { font-size: 8pt; } th, td { padding-right: 7px; }
  pre { white-space: pre-wrap; } .row > div { flex: 0 1 47%; } .row > div:has(.row), .row > div.wide { flex-basis: 100%; }
  svg, tr, p.caption, .row > div { break-inside: avoid; } h2, h3, .caption { break-after: avoid; }
  * { print-color-adjust: exact; }
}
)css";

}   // namespace bedload
