// The story that a session tells: captions and the like, beside what was recorded.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

// Its text, whatever it holds, as the attribute "story" of the file's root. The session is complete
// already and has none; it stays as it is until its copy with the story is on the disk. Errors:
// FileError, and the session is as before.
void attach_story(const std::filesystem::path& session, const std::string& story);
// Of a file that read_session() has read: empty where there is none, and of a recording that still
// runs. Errors: FileError for a text that cannot be read.
std::string attached_story(const std::filesystem::path& session);

}  // namespace limpid
