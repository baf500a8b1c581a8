#include "coordinator/report/html_page.h"

#include "coordinator/plot/svg.h"

namespace fatmc::html {
namespace {

// Colours of text have a contrast of at least 4.5 on their ground.
constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ground:#fff;--ink:#202124;--faint:#5f6368;--rule:#dadce0;--tint:#f6f7f8;--link:#0b57d0;
--exact:#0b6b4f;--match:#0b57a4;--shape:#8a5300;--differs:#b3261e}
@media (prefers-color-scheme:dark){:root{--ground:#17181a;--ink:#e8eaed;--faint:#a8adb3;--rule:#3c4043;--tint:#202225;
--link:#8ab4f8;--exact:#4cc9a0;--match:#7ab7f0;--shape:#f0b060;--differs:#ff8a80}}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--ground);color:var(--ink);font:16px/1.5 system-ui,'DejaVu Sans',sans-serif}
main,header,footer{max-width:72rem;margin:0 auto;padding:0 1rem}
h1{font-size:1.6rem;line-height:1.2;margin:1.5rem 0 .5rem}
h2{font-size:1.3rem;margin:2.5rem 0 .5rem;padding-top:.5rem;border-top:1px solid var(--rule)}
h3{font-size:1.05rem;margin:1.6rem 0 .4rem}
p{margin:.5rem 0;max-width:46rem}a{color:var(--link)}
nav ul,.plain{list-style:none;padding:0;margin:.5rem 0}nav li{margin:.15rem 0}
.faint{color:var(--faint)}.small{font-size:.85rem}
.scroll{overflow-x:auto;margin:.5rem 0}
table{border-collapse:collapse;font-size:.85rem;line-height:1.35}
th,td{padding:.25rem .6rem;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
th{font-weight:600;background:var(--tint)}td.number,th.number{text-align:right;white-space:nowrap;
font-variant-numeric:tabular-nums}
.verdict{font-weight:600}.exact{color:var(--exact)}.match{color:var(--match)}.shape{color:var(--shape)}
.differs{color:var(--differs)}
.partial{border-left:4px solid var(--differs);padding:.3rem .8rem;background:var(--tint)}
.figures{display:flex;flex-wrap:wrap;gap:0 1.5rem;align-items:flex-start}
figure{margin:1rem 0;max-width:100%}figure svg{display:block}
figcaption{font-size:.85rem;margin-top:.3rem;width:0;min-width:min(100%,46rem)}
ol.reasons{font-size:.85rem;padding-left:1.8rem;margin:.4rem 0;max-width:60rem}
code{font-size:.85em;overflow-wrap:anywhere}
footer{border-top:1px solid var(--rule);margin-top:3rem;padding-bottom:2rem}
@media print{:root{--ground:#fff;--ink:#000;--faint:#444;--rule:#bbb;--tint:#fff}body{font-size:10pt}nav{display:none}
h2{break-before:page}figure,tr{break-inside:avoid}.scroll{overflow:visible}figure svg{max-width:100%;height:auto}}
)";

std::string cell(const char* tag, const Column& column, const std::string& content) {
  return std::string("<") + tag + (column.numeric ? " class=\"number\">" : ">") + content + "</" + tag + ">";
}

}  // namespace

std::string text(std::string_view plain) { return plot::escaped(std::string(plain)); }

std::string anchor(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) {
      out += upper ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!out.empty() && out.back() != '-') {
      out += '-';
    }
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

std::string figure(const plot::Figure& figure, const std::string& id, std::string_view label,
                   std::string_view caption) {
  return "<figure id=\"" + id + "\"><div class=\"scroll\">" + plot::inline_svg(figure, id) +
         "</div><figcaption><b>" + text(label) + "</b> " + text(caption) + "</figcaption></figure>\n";
}

std::string table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (const Column& column : columns) out += cell("th", column, text(column.heading));
  out += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < columns.size(); ++i) out += cell("td", columns[i], row.at(i));
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string page(std::string_view title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         text(title) + "</title>\n<style>" + kStyle + plot::svg_style() + "</style></head>\n<body>\n" + body +
         "</body></html>\n";
}

}  // namespace fatmc::html
