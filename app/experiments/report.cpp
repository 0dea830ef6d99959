#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/markup.h"
#include "app/experiments/live.h"
#include "app/figure/page.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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
  write_page(
      dir / "report.html", "Transparent virtual coupling: experiments",
      fmt::format("{} of {} experiments passed.", passed, pages.size()),
      fmt::format("<section><table><tbody>\n{}</tbody></table></section>\n{}", contents, sections));
}

}  // namespace limpid
