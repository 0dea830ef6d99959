// Small pictures of sessions, for lists of files. They are in the user's cache and may go any time.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "app/desktop/base/stage.h"

namespace limpid {

inline constexpr int kThumbnailWidth = 256, kThumbnailHeight = 144;  // [px]
inline constexpr std::size_t kMostThumbnails = 64;

// What a session's picture is called, whether there is one or not; the same for the same file.
std::filesystem::path thumbnail_of(const std::filesystem::path& session);

// What a list shows of a recording or a scene, whether it is there or not: of scenes that came with
// Limpid, and of the sessions recorded in them, the picture that came along, too.
std::filesystem::path picture_of(const std::filesystem::path& file);

// Draws one of a row, and of a twin's, and keeps it; the oldest ones go where there are too many.
// Needs a current OpenGL context. Never throws: a picture less is no harm.
void make_thumbnail(const std::filesystem::path& session, Stage& stage, std::span<const double> row,
                    std::span<const double> twin, Theme theme);
// Removes the oldest pictures of a folder beyond that many.
void keep_newest(const std::filesystem::path& folder, std::size_t most);

}  // namespace limpid
