#include "app/cli/manual_page.h"

#include <fmt/format.h>
#include <md4c-html.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <utility>

#include "app/base/markup.h"
#include "app/base/version.h"
#include "app/cli/options.h"
#include "core/tick/parameters.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPage = std::size_t{1} << 20;
constexpr std::size_t kLargestPicture = std::size_t{4} << 20;

// A chapter: a README and its name in the list of contents.
struct Chapter {
  const char *file, *name;
};
constexpr std::array kChapters{
    Chapter{"README.md", "Limpid"},
    Chapter{"core/README.md", "Laws and real time"},
    Chapter{"devices/README.md", "Devices and safety"},
    Chapter{"devices/LABORATORIES.md", "A new device"},
    Chapter{"devices/files/README.md", "Arms, scenes, sessions"},
    Chapter{"render/model/README.md", "Models"},
    Chapter{"app/experiments/README.md", "Experiments"},
    Chapter{"assets/sweeps/README.md", "Sweeps"},
    Chapter{"assets/stories/README.md", "Stories"},
    Chapter{"assets/python/limpid/README.md", "Python"},
    Chapter{"assets/python/lessons/README.md", "Lessons"},
    Chapter{"app/library/README.md", "Library"},
};

// The part of a link behind '#', as on the pages of a forge: "A delay" becomes "a-delay".
std::string anchor_of(std::string_view heading) {
  std::string out;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') out += '-';
    if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80) {
      out += static_cast<char>(byte < 0x80 ? std::tolower(byte) : byte);
    }
  }
  return out;
}

std::string anchor_in(const fs::path& file, std::string_view fragment) {
  std::string of_file = file.generic_string();
  std::ranges::replace(of_file, '/', '-');
  return fragment.empty() ? of_file : fmt::format("{}--{}", of_file, fragment);
}

// Returns the target within the page of a chapter's link; empty: it leads out of it.
std::string within_page(const Chapter& from, const std::string& link) {
  const std::size_t hash = std::min(link.find('#'), link.size());
  const std::string fragment = hash < link.size() ? link.substr(hash + 1) : "";
  fs::path file = from.file;
  if (hash > 0) file = (file.parent_path() / link.substr(0, hash)).lexically_normal();
  const auto chapter = std::ranges::find_if(
      kChapters, [&](const Chapter& each) { return file == fs::path(each.file); });
  return chapter == kChapters.end() ? "" : "#" + anchor_in(file, fragment);
}

// Text without tags.
std::string plain_text(std::string_view html) {
  std::string out;
  bool tag = false;
  for (const char c : html) {
    if (c == '<') tag = true;
    if (!tag) out += c;
    if (c == '>') tag = false;
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t first = 0; first < bytes.size(); first += 3) {
    std::uint32_t three = 0;
    for (std::size_t i = first; i < first + 3; ++i) {
      three = three << 8 | (i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u);
    }
    for (const int shift : {18, 12, 6, 0}) out += kDigits[three >> shift & 63u];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  return out.replace(out.size() - padding, padding, padding, '=');
}

// Returns the picture that a chapter shows, as an address that holds it.
std::string picture_data(const fs::path& tree, const Chapter& chapter, const std::string& link) {
  constexpr std::array<std::pair<const char*, const char*>, 3> kKinds{
      {{".gif", "gif"}, {".png", "png"}, {".svg", "svg+xml"}}};
  const fs::path file = (tree / chapter.file).parent_path() / link;
  const auto kind = std::ranges::find_if(
      kKinds, [&](const auto& each) { return file.extension() == each.first; });
  if (kind == kKinds.end()) {
    throw FileError(fmt::format("{}: {}: no GIF, PNG or SVG", chapter.file, link));
  }
  try {
    return fmt::format("data:image/{};base64,{}", kind->second,
                       base64(read_text(file, kLargestPicture)));
  } catch (const FileError& error) {
    throw FileError(fmt::format("{}: {}", chapter.file, error.what()));
  }
}

// Replaces links to files that are not in the page by their text, gives headings anchors, and puts
// pictures into the page.
std::string for_one_page(const fs::path& tree, const Chapter& chapter, const std::string& html) {
  constexpr std::string_view kPicture = "<img src=\"";
  std::string out;
  std::size_t at = 0;
  while (at < html.size()) {
    const std::size_t tag = html.find('<', at);
    out += html.substr(at, tag - at);
    if (tag == std::string::npos) break;
    const std::size_t end = html.find('>', tag) + 1;
    const std::string_view whole = std::string_view(html).substr(tag, end - tag);
    at = end;
    if (whole.size() == 4 && whole[1] == 'h' &&
        std::isdigit(static_cast<unsigned char>(whole[2]))) {
      const std::size_t close = html.find("</h", end);
      const std::string text = plain_text(std::string_view(html).substr(end, close - end));
      out += fmt::format("<h{} id=\"{}\">", whole[2], anchor_in(chapter.file, anchor_of(text)));
    } else if (whole.starts_with("<a href=\"")) {
      const std::string link(whole.substr(9, whole.find('"', 9) - 9));
      const bool web = link.find("://") != std::string::npos;
      const std::string target = web ? link : within_page(chapter, link);
      out += target.empty() ? "<a>" : fmt::format("<a href=\"{}\">", target);
    } else if (whole.starts_with(kPicture)) {
      const std::size_t after = whole.find('"', kPicture.size());
      const std::string link(whole.substr(kPicture.size(), after - kPicture.size()));
      out += kPicture;
      out += picture_data(tree, chapter, link);
      out += whole.substr(after);
    } else {
      out += whole;
    }
  }
  return out;
}

std::string html_of(const std::string& markdown) {
  std::string html;
  const auto take = [](const MD_CHAR* text, MD_SIZE size, void* into) {
    static_cast<std::string*>(into)->append(text, size);
  };
  md_html(markdown.data(), static_cast<MD_SIZE>(markdown.size()), take, &html, MD_DIALECT_GITHUB,
          MD_HTML_FLAG_SKIP_UTF8_BOM);
  return html;
}

std::string settings_html() {
  std::string out =
      "<h1 id=\"settings\">All settings</h1><p>Use these keys in <code>--set KEY=VALUE</code>, in "
      "files of <code>--config</code>, with sliders and in "
      "Python.</p><table><thead><tr><th>key</th><th>default</th><th>allowed</th><th></th></tr></"
      "thead><tbody>\n";
  for (const ParameterInfo& info : parameter_table()) {
    const std::string usual = parameter_text(Parameters{}, info);
    out += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                       info.key, usual.empty() ? "automatic" : escaped(usual),
                       escaped(allowed_values(info)), escaped(info.meaning));
  }
  return out + "</tbody></table>";
}

std::string keys_html(const std::vector<ManualKey>& keys) {
  std::string out = "<h1 id=\"keys\">Keys and mouse</h1>";
  std::string group;
  for (const ManualKey& key : keys) {
    if (group != key.group) {
      out += fmt::format("{}<h2>{}</h2><table><tbody>\n", group.empty() ? "" : "</tbody></table>",
                         escaped(key.group));
      group = key.group;
    }
    out += fmt::format("<tr><td><kbd>{}</kbd></td><td>{}</td></tr>\n", escaped(key.keys),
                       escaped(key.what));
  }
  return out + "</tbody></table>";
}

// {0}: version, {1}: contents, {2}: chapters.
constexpr const char* kPage = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Limpid, the manual</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root {{ color-scheme: light dark; }}
body {{ font: 16px/1.5 Inter, sans-serif; margin: 0; display: flex; }}
nav {{ position: sticky; top: 0; height: 100vh; overflow: auto; padding: 1em; width: 15em; flex: none;
  box-sizing: border-box; border-right: 1px solid #8884; }}
nav a {{ display: block; text-decoration: none; padding: 0.15em 0; }}
nav input {{ width: 100%; box-sizing: border-box; font: inherit; }}
main {{ padding: 0 2em 4em; max-width: 60em; min-width: 0; }}
img {{ max-width: 100%; height: auto; }}
table {{ border-collapse: collapse; display: block; overflow-x: auto; }}
td, th {{ border-bottom: 1px solid #8884; padding: 0.3em 0.8em 0.3em 0; text-align: left; vertical-align: top; }}
pre {{ overflow-x: auto; padding: 0.8em; background: #8882; }}
code, kbd {{ font-size: 0.9em; }}
section.without {{ display: none; }}
</style></head><body>
<nav><p>Limpid {0}</p><input type="search" placeholder="Search" aria-label="Search" id="words">
<p id="found"></p>{1}</nav><main>{2}</main>
<script>
const sections = [...document.querySelectorAll("section")];
document.getElementById("words").addEventListener("input", event => {{
  const words = event.target.value.toLowerCase().split(/\s+/).filter(word => word);
  let count = 0;
  for (const section of sections) {{
    const text = section.textContent.toLowerCase();
    const has = words.every(word => text.includes(word));
    section.classList.toggle("without", !has);
    count += has;
  }}
  document.getElementById("found").textContent = words.length ? `${{count}} of ${{sections.length}} parts` : "";
}});
</script></body></html>
)";

// Puts each part from a heading to the next one into a section, for the search.
std::string in_sections(const std::string& html) {
  std::string out = "<section>";
  std::size_t at = 0;
  for (std::size_t i = html.find("<h2", 1); i != std::string::npos; i = html.find("<h2", i + 1)) {
    out += html.substr(at, i - at) + "</section>\n<section>";
    at = i;
  }
  return out + html.substr(at) + "</section>\n";
}

}  // namespace

std::string manual_html(const fs::path& tree, const std::vector<ManualKey>& keys) {
  std::string contents, chapters;
  for (const Chapter& chapter : kChapters) {
    contents += fmt::format("<a href=\"#{}\">{}</a>\n", anchor_in(chapter.file, ""), chapter.name);
    const std::string html =
        for_one_page(tree, chapter, html_of(read_text(tree / chapter.file, kLongestPage)));
    chapters +=
        fmt::format("<a id=\"{}\"></a>\n{}", anchor_in(chapter.file, ""), in_sections(html));
  }
  contents += "<a href=\"#settings\">All settings</a>\n<a href=\"#keys\">Keys and mouse</a>\n";
  chapters += in_sections(settings_html()) + in_sections(keys_html(keys));
  return fmt::format(kPage, program_version(), contents, chapters);
}

}  // namespace limpid
