// A report as a web page of its own, for the screen and for paper.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

// `body`: HTML, of <section>s with <header>, <figure>, <table>; classes: soft, number, verdict,
// passed, failed. `summary`: a sentence, after version and time. Errors: FileError.
void write_page(const std::filesystem::path& file, const std::string& title,
                const std::string& summary, const std::string& body);

}  // namespace limpid
