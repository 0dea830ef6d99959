// Parts of a step that a script and a session's file spell alike.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/story/story.h"
#include "devices/files/toml_reader.h"

namespace limpid {

const char* view_word(Camera::View view);

// Errors of all: FileError for values that are not allowed. Nothing where the key is missing.
std::optional<StoryCamera> camera_said(const TomlTable& step, const std::string& where);
std::optional<std::array<std::string, 2>> names_said(const TomlTable& step);
bool flag_in(const TomlTable& step, const char* key, bool otherwise);

}  // namespace limpid
