"""Style sheet of the page: one column on a phone, light and dark, nothing from elsewhere."""

STYLE = """
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c1f23; --soft: #59616b; --line: #d5dae0; --card: #f5f7f9;
  --table: #eef1f4; --good: #1a7f37; --bad: #b42318; --warn: #8a5a00; --s: #0b63b8; --gap: #a6480a; --jaws: #1c1f23; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171a; --ink: #e7eaee; --soft: #a3acb7; --line: #363d45;
  --card: #1d2126; --table: #262b31; --good: #5dd17c; --bad: #ff8d84; --warn: #e6b450; --s: #73b7ff; --gap: #ffa56b;
  --jaws: #f2f4f6; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: .5rem 0; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--line); padding-bottom: .25rem; }
h3 { font-size: 1rem; margin: 0 0 .4rem; }
p { margin: .4rem 0; overflow-wrap: anywhere; }
.soft, figcaption, caption { color: var(--soft); font-size: .9rem; }
.code { display: inline-block; border: 1px solid currentColor; border-radius: .3rem; padding: 0 .4rem;
  font: 600 .85rem/1.5 ui-monospace, monospace; overflow-wrap: anywhere; }
.good { color: var(--good); } .bad { color: var(--bad); } .warn { color: var(--warn); }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr));
  gap: .6rem; margin: 1rem 0; padding: 0; }
.facts div { background: var(--card); border-radius: .5rem; padding: .6rem .8rem; }
.facts dt { color: var(--soft); font-size: .85rem; } .facts dd { margin: 0; font-size: 1.15rem; font-weight: 600; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 18rem), 1fr)); gap: 1rem; }
figure { margin: 0; } figcaption { margin: .2rem 0; }
img { display: block; max-width: 100%; height: auto; border-radius: .4rem; background: #ffffff; }
.film img { max-height: 26rem; }
.still { display: none; }
@media (prefers-reduced-motion: reduce) { .film img { display: none; } .still { display: block; } }
.scroll { overflow-x: auto; } .wide img { max-width: none; width: max(100%, 44rem); }
.card { background: var(--card); border-radius: .6rem; padding: .8rem; margin: .8rem 0; }
.chart, .view { display: block; width: 100%; height: auto; }
.chart text { font: 12px system-ui, sans-serif; fill: var(--soft); }
.grid { stroke: var(--line); } .limit { stroke: var(--gap); stroke-dasharray: 5 4; }
.curve { fill: none; stroke-width: 2.2; stroke-linejoin: round; }
.curve.s { stroke: var(--s); } .dot.s { fill: var(--s); }
.curve.gap { stroke: var(--gap); } .dot.gap { fill: var(--gap); }
.view .table { fill: var(--table); }
.view .block { fill-opacity: .75; stroke: var(--ink); stroke-width: .8; stroke-linejoin: round; }
.view .ghost { fill: none; stroke: var(--soft); stroke-width: .8; stroke-dasharray: 3 2; }
.view .name { font: 700 11px system-ui, sans-serif; fill: #000000; }
.view .jaws { fill: var(--jaws); fill-opacity: .55; } .view .head { fill: var(--jaws); }
.view .arrow { stroke: var(--jaws); stroke-width: 2.4; }
table { border-collapse: collapse; width: 100%; } caption { text-align: left; padding: .2rem 0; }
th, td { text-align: right; padding: .3rem .5rem;
  border-bottom: 1px solid var(--line); font-variant-numeric: tabular-nums; }
th:first-child { text-align: left; } td.text, th.text { text-align: left; }
.bar { display: block; height: .5rem; border-radius: .25rem; background: var(--s); min-width: 2px; }
.times { display: grid; grid-template-columns: auto auto minmax(4rem, 1fr); gap: .35rem .8rem; align-items: center; }
.times dt, .times dd { margin: 0; } .times dd { text-align: right; font-variant-numeric: tabular-nums; }
footer { color: var(--soft); font-size: .85rem; margin: 2rem 0; overflow-wrap: anywhere; }
:focus-visible { outline: 3px solid var(--s); outline-offset: 2px; }
"""
