// The manual's page: pictures of the READMEs are in it.
#include "app/cli/manual_page.h"

#include "app/base/version.h"
#include "core/tick/parameters.h"
#include "devices/files/text_file.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

// Whether a page, which is too long to be told, holds a part.
bool holds_part(const std::string& html, const std::string& part) {
  return html.find(part) != std::string::npos;
}

// A source tree whose first page is the test's own.
class ManualPage : public testing::Test {
 protected:
  ManualPage() {
    for (const char* room : {"app", "assets", "core", "devices", "render"}) {
      fs::create_directory_symlink(fs::path(LIMPID_SOURCE_DIR) / room, temp_ / room);
    }
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream(temp_ / name, std::ios::binary) << text;
  }
  std::string page() const { return manual_html(temp_ / ".", {}); }
  // Returns what is said of a first page that no manual can be made of.
  std::string refused(const std::string& first_page) const {
    write("README.md", first_page);
    try {
      page();
    } catch (const FileError& error) {
      return error.what();
    }
    ADD_FAILURE() << "a page was made of " << first_page;
    return {};
  }

  const test::TempDir temp_;
};

// Base64 of RFC 4648, section 10, and of bytes that are no text.
TEST_F(ManualPage, HoldsPicturesAsDataWithTheirWords) {
  write("a.png", "f");
  write("b.gif", "fo");
  write("c.svg", "foo");
  write("d.png", "foob");
  write("e.png", std::string("\xfb\xff\xfe\0", 4));
  write(
      "README.md",
      "![of \"one\" > two](a.png) ![b](b.gif \"said\")\n\n![c](c.svg)\n![d](d.png)\n![e](e.png)\n");
  const std::string html = page();
  for (const char* picture :
       {R"(<img src="data:image/png;base64,Zg==" alt="of &quot;one&quot; &gt; two">)",
        R"(<img src="data:image/gif;base64,Zm8=" alt="b" title="said">)",
        R"(<img src="data:image/svg+xml;base64,Zm9v" alt="c">)",
        R"(<img src="data:image/png;base64,Zm9vYg==" alt="d">)",
        R"(<img src="data:image/png;base64,+//+AA==" alt="e">)"}) {
    EXPECT_NE(html.find(picture), std::string::npos) << picture;
  }
  EXPECT_TRUE(page() == html) << "the same tree gives the same page";
}

// Links within the manual stay in it, those to the web lead there, and others are their text.
TEST_F(ManualPage, LeadsToItsChaptersAndTheWeb) {
  write("README.md",
        "# The `--set` *Key* of X_1\n\n"
        "[web](https://example.org/a#b) [laws](core/README.md) [part](core/README.md#a-delay)\n"
        "[here](#the-end) [code](app/program.h) [up](core/../devices/README.md)\n\n"
        "## The end\n\nWords.\n\n### Below\n\n## \xC3\x84rger, twice!\n\nMore.\n");
  const std::string html = page();
  for (const char* part :
       {"<h1 id=\"README.md--the---set-key-of-x_1\">The <code>--set</code> <em>Key</em> of "
        "X_1</h1>",
        "<a href=\"https://example.org/a#b\">web</a>", "<a href=\"#core-README.md\">laws</a>",
        "<a href=\"#core-README.md--a-delay\">part</a>", "<a href=\"#README.md--the-end\">here</a>",
        "<a>code</a>", "<a href=\"#devices-README.md\">up</a>",
        "<h2 id=\"README.md--the-end\">The end</h2>", "<h3 id=\"README.md--below\">Below</h3>",
        "<h2 id=\"README.md--\xC3\x84rger-twice\">"}) {
    EXPECT_TRUE(holds_part(html, part)) << part;
  }
}

TEST_F(ManualPage, HasASectionForEachPartOfAChapter) {
  write("README.md", "# One\n\nfirst\n\n## Two\n\nsecond\n\n## Three\n\nthird\n");
  EXPECT_TRUE(holds_part(page(),
                         "<main><a id=\"README.md\"></a>\n"
                         "<section><h1 id=\"README.md--one\">One</h1>\n<p>first</p>\n"
                         "</section>\n<section><h2 id=\"README.md--two\">Two</h2>\n"
                         "<p>second</p>\n</section>\n"
                         "<section><h2 id=\"README.md--three\">Three</h2>\n<p>third</p>\n"
                         "</section>\n<a id=\"core-README.md\"></a>\n"));
}

TEST_F(ManualPage, ListsChaptersSettingsAndKeys) {
  write("README.md", "# One\n");
  const std::string html = manual_html(
      temp_ / ".", {{"View", "F1", "help"}, {"View", "A & B", "<x>"}, {"Mouse", "wheel", "zoom"}});
  EXPECT_TRUE(holds_part(html,
                         "<p id=\"found\"></p><a href=\"#README.md\">Limpid</a>\n"
                         "<a href=\"#core-README.md\">Laws and real time</a>\n"
                         "<a href=\"#devices-README.md\">Devices and safety</a>\n"));
  EXPECT_TRUE(holds_part(html,
                         "<a href=\"#app-library-README.md\">Library</a>\n"
                         "<a href=\"#settings\">All settings</a>\n"
                         "<a href=\"#keys\">Keys and mouse</a>\n</nav>"));
  EXPECT_TRUE(holds_part(html,
                         "<h1 id=\"keys\">Keys and mouse</h1></section>\n"
                         "<section><h2>View</h2><table><tbody>\n"
                         "<tr><td><kbd>F1</kbd></td><td>help</td></tr>\n"
                         "<tr><td><kbd>A &amp; B</kbd></td><td>&lt;x&gt;</td></tr>\n"
                         "</tbody></table></section>\n<section><h2>Mouse</h2><table><tbody>\n"
                         "<tr><td><kbd>wheel</kbd></td><td>zoom</td></tr>\n"
                         "</tbody></table></section>\n</main>"));
  for (const char* row :
       {"<tr><td><code>coupling.eta</code></td><td>", "<td>automatic</td>",
        "<code>observer.anti_windup</code></td><td>true</td><td>true, false</td>",
        "<code>hand.stiffness</code></td><td>300.0</td><td>0 to 100000 N/m</td>"}) {
    EXPECT_TRUE(holds_part(html, row)) << row;
  }
  std::size_t rows = 0;
  const std::size_t begin = html.find("id=\"settings\"");
  for (std::size_t at = begin; (at = html.find("<tr><td><code>", at)) != std::string::npos; ++at) {
    ++rows;
  }
  EXPECT_EQ(rows, parameter_table().size());
  EXPECT_TRUE(holds_part(html, "<nav><p>Limpid " + std::string(program_version()) + "</p>"));
}

TEST_F(ManualPage, IsNotMadeWhereAPictureIsMissing) {
  EXPECT_THAT(refused("![a view](views/gone.png)"),
              AllOf(HasSubstr("README.md: "), HasSubstr("views/gone.png: no such file")));
}

TEST_F(ManualPage, IsNotMadeOfPicturesThatBrowsersMayNotShow) {
  write("view.tiff", "II*");
  EXPECT_THAT(refused("![a view](view.tiff)"),
              AllOf(HasSubstr("README.md: "), HasSubstr("view.tiff: no GIF, PNG or SVG")));
}

}  // namespace
}  // namespace limpid
