// How the page looks.
#pragma once

namespace gyrolog {

// Rules are told apart by lines and weight, not by colour. On a dark screen the pictures, which have white
// paper, are turned dark, to the page's own; the hues stay. On paper no picture is higher than a page of A4.
inline constexpr const char* page_style = R"(
:root { color-scheme: light dark; --ink: #1c1e22; --paper: #ffffff; --muted: #5c6068; --line: #b9bcc2; --head: #f0f1f3; }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e3e5e9; --paper: #141414; --muted: #a3a8b0; --line: #4a4e56; --head: #23262b; }
  img { filter: invert(0.92) hue-rotate(180deg); }
}
body { max-width: 54rem; margin: 2rem auto; padding: 0 1rem; color: var(--ink); background: var(--paper);
  font: 15px/1.5 "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 0.2rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 0.6rem; padding-bottom: 0.2rem; border-bottom: 2px solid var(--line); }
h3 { font-size: 1rem; margin: 1.4rem 0 0.4rem; }
p { margin: 0.5rem 0; }
.muted, figcaption, footer { color: var(--muted); font-size: 0.87rem; }
.verdict { font-size: 1.05rem; font-weight: bold; border-left: 4px solid var(--ink); padding-left: 0.7rem; }
.warning { border: 1px solid var(--ink); border-left-width: 4px; padding: 0.3rem 0.8rem; margin: 0.8rem 0; }
table { border-collapse: collapse; width: 100%; margin: 0.6rem 0; font-size: 0.87rem;
  font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: 0.22rem 0.6rem 0.22rem 0; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--ink); }
tbody th { font-weight: normal; color: var(--muted); }
tr.group th { background: var(--head); color: var(--ink); padding: 0.4rem 0.5rem; }
table.numbers td { white-space: nowrap; }
table.names tbody th, table.names td:nth-child(2), table.errors tbody th, table.errors td:last-child { overflow-wrap: anywhere; }
table.facts th { width: 9rem; }
ul { margin: 0.4rem 0; padding-left: 1.3rem; }
figure { margin: 1rem 0; }
img { display: block; width: 100%; height: auto; }
@media screen and (max-width: 50rem) { table { display: block; overflow-x: auto; } }
footer { margin-top: 2.5rem; border-top: 1px solid var(--line); padding-top: 0.5rem; }
@page { size: A4; margin: 16mm 15mm; }
@media print {
  :root { color-scheme: light; }
  body { max-width: none; margin: 0; padding: 0; font-size: 10pt; }
  h2, h3, h2 + p, tr.group, tbody tr:first-child, tr:nth-last-child(2) { break-after: avoid; }
  img, tr, li, .warning, table:not(:has(tr:nth-child(9))) { break-inside: avoid; }
  figcaption, footer { break-before: avoid; }
  footer { margin-top: 1rem; }
  img { width: auto; max-width: 100%; max-height: 240mm; margin: 0 auto; }
  tr.group th { print-color-adjust: exact; }
}
)";

}  // namespace gyrolog
