#include "line/report/html.h"
namespace venato::line {

const char* const kReportStyle = R"css(
:root{--ink:#1f2328;--soft:#5b646e;--rule:#dfe3e8;--paper:#fff;--wash:#f6f7f8;--good:#0b6e4f;--fair:#9a6700;--bad:#b42318;--accent:#0072b2}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 -apple-system,BlinkMacSystemFont,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main,header{max-width:1060px;margin:0 auto;padding:0 20px}
header{padding-top:36px}
h1{font-size:1.9rem;line-height:1.2;margin:0 0 4px;letter-spacing:-.01em}
h2{font-size:1.3rem;margin:52px 0 12px;padding-top:14px;border-top:1px solid var(--rule)}
h3{font-size:1.05rem;margin:32px 0 8px}
p{margin:8px 0;max-width:72ch}
.sub{color:var(--soft);margin:0}
.verdict{border-left:5px solid var(--soft);background:var(--wash);padding:14px 18px;margin:22px 0;border-radius:0 6px 6px 0}
.verdict.good{border-color:var(--good)}.verdict.fair{border-color:var(--fair)}.verdict.bad{border-color:var(--bad)}
.verdict strong{display:block;font-size:1.15rem;margin-bottom:2px}
nav{display:flex;flex-wrap:wrap;gap:4px 18px;margin-top:14px;font-size:.92rem}
a{color:var(--accent);text-decoration:none}a:hover{text-decoration:underline}
.scroll{overflow-x:auto}
table{border-collapse:collapse;margin:12px 0;font-size:.93rem;font-variant-numeric:tabular-nums}
th,td{padding:6px 14px 6px 0;text-align:left;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600;color:var(--soft)}
td.n,th.n{text-align:right;white-space:nowrap}
tr.main td{font-weight:600}
.score td:first-child{white-space:nowrap}.score td:last-child{font-weight:400;min-width:17em}
.score th.n{white-space:normal}
code{font:.88em/1.4 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;overflow-wrap:anywhere}
figure{margin:0}
figure img{display:block;width:100%;height:auto;border:1px solid var(--rule);border-radius:4px;background:#fff}
figcaption{font-size:.88rem;color:var(--soft);margin-top:6px}
figcaption b{color:var(--ink);font-weight:600;display:block}
.grid{display:grid;gap:26px 22px;grid-template-columns:repeat(auto-fill,minmax(280px,1fr));margin:16px 0}
.grid.plots{grid-template-columns:repeat(auto-fill,minmax(330px,1fr))}
.wide{margin:18px 0}
.pass{color:var(--good)}.fail{color:var(--bad);font-weight:600}
.slider{position:relative;max-width:560px;margin:16px 0 4px;border:1px solid var(--rule);border-radius:4px;overflow:hidden;--cut:50%}
.slider img{display:block;width:100%;height:auto}
.slider .top{position:absolute;inset:0;clip-path:inset(0 calc(100% - var(--cut)) 0 0)}
.slider .bar{position:absolute;top:0;bottom:0;left:var(--cut);width:2px;margin-left:-1px;background:#1f2328;pointer-events:none}
.slider .tag{position:absolute;top:8px;padding:2px 8px;font-size:.8rem;background:rgba(255,255,255,.88);border-radius:3px;pointer-events:none}
.slider .tag.l{left:8px}.slider .tag.r{right:8px}
.slider input{position:absolute;inset:0;width:100%;height:100%;margin:0;opacity:0;cursor:ew-resize}
.slider input:focus-visible{opacity:.18}
.key span{display:inline-block;margin-right:16px;font-size:.88rem;color:var(--soft)}
.key i{display:inline-block;width:12px;height:12px;border-radius:2px;margin-right:6px;vertical-align:-1px}
ul.plain{padding-left:18px}
footer{max-width:1060px;margin:56px auto 40px;padding:14px 20px 0;border-top:1px solid var(--rule);color:var(--soft);font-size:.85rem}
@media (max-width:560px){body{font-size:15px}h1{font-size:1.5rem}th,td{padding-right:10px}.grid,.grid.plots{grid-template-columns:1fr}}
@media print{body{font-size:10.5pt}nav,.slider input,.slider .bar{display:none}h2{break-after:avoid}figure,tr,.verdict{break-inside:avoid}
.slider{overflow:visible;border:0;display:grid;grid-template-columns:1fr 1fr;gap:12px;max-width:none}.slider .top{position:static;clip-path:none}.slider .tag{position:static;grid-row:1}.slider .tag.l{grid-column:1}.slider .tag.r{grid-column:2}.slider .top{grid-row:2;grid-column:1}.slider .under{grid-row:2;grid-column:2}
.grid{grid-template-columns:repeat(3,1fr)}.grid.plots{grid-template-columns:repeat(2,1fr)}}
)css";

const char* const kReportScript = R"js(
document.querySelectorAll('.slider').forEach(function(s){
  var input=s.querySelector('input');
  function move(){s.style.setProperty('--cut',input.value+'%')}
  input.addEventListener('input',move);move();
});
)js";
}  // namespace venato::line
