// The style that the report's sections share: a light page, one column, tables with aligned figures.
#pragma once

#include <string_view>

namespace bedload {

inline constexpr std::string_view report_style = R"css(
:root { color-scheme: light; }
body { margin: 0; background: #f4f6f7; color: #22292e; font: 15px/1.55 system-ui, -apple-system, "Segoe UI", "Liberation Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1020px; margin: 0 auto; padding: 28px 24px 64px; }
header h1 { font-size: 27px; margin: 0 0 2px; letter-spacing: -0.01em; }
header p { margin: 0; color: #5b6770; }
section { background: #fff; border: 1px solid #e0e5e8; border-radius: 8px; padding: 18px 24px 20px; margin-top: 20px; }
h2 { font-size: 18px; margin: 0 0 4px; }
h3 { font-size: 14px; margin: 14px 0 4px; }
.moment { font-weight: 400; color: #5b6770; }
sub { line-height: 0; }
p.caption { margin: 0 0 12px; color: #5b6770; font-size: 13.5px; max-width: 92ch; }
.row { display: flex; flex-wrap: wrap; gap: 8px 22px; }
svg { display: block; max-width: 100%; height: auto; font-size: 12px; font-family: inherit; fill: #333; }
svg .grid { stroke: #dfe4e7; stroke-width: 1; } svg .fine { stroke: #eff2f3; stroke-width: 1; }
svg .frame { fill: none; stroke: #7d8890; } svg .axis { font-size: 13px; fill: #22292e; }
svg .heading { font-weight: 600; fill: #22292e; } svg .note { font-size: 12px; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; width: 100%; }
th { text-align: left; font-weight: 600; color: #5b6770; border-bottom: 1px solid #c6ced3; padding: 4px 14px 4px 0; vertical-align: bottom; }
td { border-bottom: 1px solid #edf0f2; padding: 4px 14px 4px 0; vertical-align: top; }
td.n, th.n { text-align: right; }
.tag { display: inline-block; white-space: nowrap; border-radius: 4px; padding: 0 7px; font-size: 12.5px; background: #e8edf0; color: #44515a; }
.tag.good { background: #dff1e8; color: #11633f; } .tag.open { background: #fdf0d5; color: #7a5200; }
code, pre { font-family: ui-monospace, "Liberation Mono", "DejaVu Sans Mono", monospace; font-size: 13px; }
pre { background: #f4f6f7; border: 1px solid #e0e5e8; border-radius: 6px; padding: 9px 12px; margin: 6px 0 10px; overflow-x: auto; }
td code { word-break: break-all; font-size: 12px; color: #5b6770; }
@media print { body { background: #fff; } section { break-inside: avoid; border: 0; padding: 0; } }
)css";

}   // namespace bedload
