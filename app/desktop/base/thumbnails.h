// Thumbnails: small pictures of sessions for lists of files, in the user's cache. They may go any
// time.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "app/stage/stage.h"

namespace limpid {

inline constexpr int kThumbnailWidth = 256, kThumbnailHeight = 144;  // [px]
inline constexpr std::size_t kMostThumbnails = 64;

// Returns the file of a session's picture, whether it exists or not.
std::filesystem::path thumbnail_of(const std::filesystem::path& session);

// Returns the file of a recording's or scene's picture, whether it exists or not. Scenes that came
// with Limpid, and the sessions recorded in them, have pictures that came along.
std::filesystem::path picture_of(const std::filesystem::path& file);

// Draws and keeps the picture of the rows of all runs; removes the oldest pictures beyond
// kMostThumbnails. Needs a current OpenGL context. Never throws: a missing picture is no harm.
void make_thumbnail(const std::filesystem::path& session, Stage& stage, LaneRows rows, Theme theme);
// Removes all but the `most` newest pictures of a folder.
void keep_newest(const std::filesystem::path& folder, std::size_t most);

}  // namespace limpid
