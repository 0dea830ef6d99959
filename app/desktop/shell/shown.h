// What is on screen: the recording that is played, or else the loop, and how it is looked at.
#pragma once

#include <span>

#include "app/desktop/base/settings.h"
#include "app/desktop/live/live_session.h"
#include "app/desktop/playback/playback.h"
#include "render/camera.h"
#include "render/quality.h"

namespace limpid {

class Shown {
 public:
  Shown(const Settings& settings, Playback& playback, LiveSession& live)
      : settings_(settings), playback_(playback), live_(live) {}

  Stage& stage() { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  const Stage& stage() const { return playback_.on() ? playback_.shown()->stage() : live_.stage(); }
  std::span<const double> row() const;       // empty before the first
  std::span<const double> twin_row() const;  // empty without a twin

  // The view is chosen for the window's size until somebody chooses one.
  bool automatic_view() const { return automatic_; }
  void keep_view() { automatic_ = false; }
  void look(Camera::View view);
  void reset_view();
  // Once a frame: from where a story's step wants to be looked at, and what it calls the runs.
  void follow_story();
  void leave_story() { step_ = nullptr; }  // the next step looks anew

  int quality_level() const;  // of Quality, as the settings want it

  Camera camera;
  AutoQuality automatic_quality;

 private:
  const Settings& settings_;
  Playback& playback_;
  LiveSession& live_;
  bool automatic_ = true;
  const StoryStep* step_ = nullptr;  // that the camera knows
};

}  // namespace limpid
