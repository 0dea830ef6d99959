#include "app/figure/page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "app/base/markup.h"
#include "app/base/version.h"
#include "devices/files/atomic_file.h"
#include "devices/files/file_error.h"

namespace limpid {
namespace {

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

}  // namespace

void write_page(const std::filesystem::path& file, const std::string& title,
                const std::string& summary, const std::string& body) {
  const std::string text = fmt::format(
      R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Limpid: {1}</title><style>{0}</style></head><body><main>
<h1>{1}</h1>
<p class="soft">Limpid {2}, {3:%e %B %Y, %H:%M}. {4}</p>
{5}</main></body></html>
)",
      kStyle, escaped(title), program_version(), fmt::localtime(std::time(nullptr)),
      escaped(summary), body);
  const std::string wrong = try_write_atomically(file, text);
  if (!wrong.empty()) throw FileError(wrong);
}

}  // namespace limpid
