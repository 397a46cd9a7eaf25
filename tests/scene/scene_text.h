/// Scenes given as text in a test.
#pragma once

#include "alcove/scene/scene.h"

#include "scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace alcove::test {

/// A scene file in a temporary folder.
class SceneText {
  public:
    explicit SceneText(const std::string& text) { std::ofstream(file()) << text; }

    std::filesystem::path file() const { return folder_ / "scene.toml"; }
    const ScratchFolder& folder() const { return folder_; }

  private:
    ScratchFolder folder_;
};

inline Scene scene_from(const std::string& text) {
    return read_scene(SceneText(text).file());
}

}
