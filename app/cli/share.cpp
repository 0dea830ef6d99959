#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>

#include "app/cli/commands.h"
#include "app/cli/complete.h"
#include "app/cli/manual.h"
#include "app/desktop/shell/icon.h"
#include "devices/files/text_file.h"
#include "render/gl/offscreen.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw FileError(file.string() + ": could not be written");
}

void write_pages(const CLI::App& app, const fs::path& folder) {
  write(folder / "limpid.1", manual_page(app, app));
  for (const CLI::App* command : shown_commands(app)) {
    write(folder / fmt::format("limpid-{}.1", command->get_name()), manual_page(app, *command));
  }
}

void write_icons(const fs::path& folder) {
  write(folder / "scalable/apps/limpid.svg", icon_svg());
  for (const int size : {16, 22, 24, 32, 48, 64, 128, 256, 512}) {
    const fs::path apps = folder / fmt::format("{0}x{0}/apps", size);
    fs::create_directories(apps);
    write_png(apps / "limpid.png", size, size, icon(size));
  }
}

}  // namespace

Command declare_share(CLI::App& app) {
  auto* command = app.add_subcommand("share", "writes manual pages and icons, to be installed");
  command->group("");
  auto into = std::make_shared<std::string>();
  command->add_option("DIR", *into, "the folder for them")->required();
  return [into, &app] {
    write_pages(app, fs::path(*into) / "man/man1");
    write_icons(fs::path(*into) / "icons/hicolor");
    return 0;
  };
}

}  // namespace limpid
