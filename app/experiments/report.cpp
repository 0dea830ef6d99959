#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/markup.h"
#include "app/base/version.h"
#include "app/experiments/live.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kStyle = R"css(
:root { --ink: #1c2126; --soft: #5b6670; --line: #dfe3e7; --good: #00734f; --bad: #b3261e; }
* { box-sizing: border-box; }
body { margin: 0; background: #f3f4f6; color: var(--ink);
       font: 15px/1.5 Inter, "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 40px 24px 64px; }
h1 { font-size: 28px; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 20px; margin: 0; letter-spacing: -0.01em; }
.soft { color: var(--soft); margin: 0; }
section { background: #fff; border: 1px solid var(--line); border-radius: 10px;
          padding: 24px 28px; margin-top: 28px; }
header { display: flex; justify-content: space-between; align-items: baseline; gap: 16px; }
figure { margin: 18px 0; }
img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { color: var(--soft); font-size: 13.5px; margin-top: 8px; }
table { width: 100%; border-collapse: collapse; font-size: 13.5px; }
th { text-align: left; font-weight: 600; color: var(--soft); }
th, td { padding: 6px 10px 6px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.verdict { font-weight: 600; white-space: nowrap; text-align: right; padding-right: 0; }
.passed { color: var(--good); } .failed { color: var(--bad); }
a { color: inherit; }
@media print {
  body { background: #fff; font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  section { border: 0; border-radius: 0; padding: 0; margin-top: 10mm; }
  section + section { break-before: page; }
  figure, tr { break-inside: avoid; }
  img { max-height: 190mm; object-fit: contain; }
}
)css";

// JSON has no infinite numbers: they are null there.
std::string number(const json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "not finite";
}

std::string verdict(bool passed) {
  return passed ? R"(<span class="passed">✓ passed</span>)"
                : R"(<span class="failed">✗ failed</span>)";
}

struct Page {
  std::string name, about;
  json verdict;
};

std::vector<Page> pages_in(const fs::path& dir) {
  std::vector<Page> pages;
  const auto add = [&](const std::string& name, const char* about) {
    std::ifstream file(dir / (name + ".json"));
    if (!file) return;
    json found = json::parse(file, nullptr, false);
    if (found.is_object() && found.contains("checks")) pages.push_back({name, about, found});
  };
  for (const Experiment& e : experiments()) add(e.name, e.about);
  for (const LiveExperiment& e : live_experiments()) add(live_name(e), e.about);
  return pages;
}

std::string section(const Page& page) {
  const json& v = page.verdict;
  std::string rows;
  for (const json& check : v.at("checks")) {
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"verdict\">{}</td></tr>\n",
        escaped(check.at("what").get<std::string>()), number(check.at("value")),
        number(check.at("bound")), verdict(check.at("passed").get<bool>()));
  }
  return fmt::format(
      R"(<section id="{0}">
<header><h2>{1}</h2>{2}</header>
<p class="soft">{0}: {3}</p>
<figure><img src="{0}.svg" alt="{1}">
<figcaption>{4} <a href="{0}.csv">data</a>, <a href="{0}.png">picture</a></figcaption></figure>
<table><thead><tr><th>Check</th><th class="number">Value</th><th class="number">Bound</th>
<th class="verdict">Verdict</th></tr></thead><tbody>
{5}</tbody></table>
</section>
)",
      page.name, escaped(v.value("title", page.name)), verdict(v.value("passed", false)),
      escaped(page.about), escaped(v.value("caption", "")), rows);
}

}  // namespace

void write_report(const fs::path& dir) {
  const std::vector<Page> pages = pages_in(dir);
  std::size_t passed = 0;
  std::string contents, sections;
  for (const Page& page : pages) {
    const bool good = page.verdict.value("passed", false);
    passed += good ? 1 : 0;
    contents += fmt::format(
        "<tr><td><a href=\"#{0}\">{1}</a></td><td class=\"soft\">{2}</td>"
        "<td class=\"number\">{3} checks</td><td class=\"verdict\">{4}</td></tr>\n",
        page.name, escaped(page.verdict.value("title", page.name)), escaped(page.about),
        page.verdict.at("checks").size(), verdict(good));
    sections += section(page);
  }
  const fs::path out = dir / "report.html";
  std::ofstream file(out);
  file << fmt::format(
      R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Limpid: experiments</title><style>{}</style></head><body><main>
<h1>Transparent virtual coupling: experiments</h1>
<p class="soft">Limpid {}, {:%e %B %Y, %H:%M}. {} of {} experiments passed.</p>
<section><table><tbody>
{}</tbody></table></section>
{}</main></body></html>
)",
      kStyle, program_version(), fmt::localtime(std::time(nullptr)), passed, pages.size(), contents,
      sections);
  if (!file.flush()) throw FileError(out.string() + ": could not be written");
}

}  // namespace limpid
