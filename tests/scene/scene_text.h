/// Scenes given as text in a test.
#pragma once

#include "alcove/scene/scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace alcove::test {

/// A scene file in a temporary folder.
class SceneText {
  public:
    explicit SceneText(const std::string& text) {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("alcove_scene_") + info->test_suite_name() + "_" + info->name());
        std::filesystem::create_directories(folder_);
        std::ofstream(file()) << text;
    }
    ~SceneText() { std::filesystem::remove_all(folder_); }
    SceneText(const SceneText&) = delete;
    SceneText& operator=(const SceneText&) = delete;

    std::filesystem::path file() const { return folder_ / "scene.toml"; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

inline Scene scene_from(const std::string& text) {
    return read_scene(SceneText(text).file());
}

}
