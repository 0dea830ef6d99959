// The manual's page: pictures of the READMEs are in it.
#include "app/cli/manual_page.h"

#include "devices/files/text_file.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

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
