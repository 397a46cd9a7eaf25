/// Textures of a mesh: files and filtering.
#include "alcove/render/detail/texture.h"

#include "alcove/render/detail/exr_file.h"
#include "alcove/render/detail/png_file.h"
#include "scratch_folder.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

TEST(Texture, PngValuesAreTakenAsTheyAre) {
    const ScratchFolder folder;
    const std::vector<std::uint16_t> grey{0, 51, 128, 255};
    write_bytes(folder / "grey.png", encode_png_file(2, 2, 1, 8, grey));
    const Texture texture = read_texture(folder / "grey.png");
    ASSERT_EQ(texture.texels.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(glm::length(texture.texels[i] - Vec3(static_cast<float>(grey[i]) / 255.0f)), 0.0f, 1e-6f);
    write_bytes(folder / "deep.png", encode_png_file(1, 1, 3, 16, std::vector<std::uint16_t>{0, 32768, 65535}));
    EXPECT_NEAR(glm::length(read_texture(folder / "deep.png").texels[0] - Vec3(0, 0.5, 1)), 0.0f, 0.004f);
}

TEST(Texture, AlphaIsIgnored) {
    const ScratchFolder folder;
    write_bytes(folder / "a.png", encode_png_file(1, 1, 4, 8, std::vector<std::uint16_t>{51, 102, 255, 0}));
    EXPECT_NEAR(glm::length(read_texture(folder / "a.png").texels[0] - Vec3(0.2f, 0.4f, 1.0f)), 0.0f, 1e-6f);
}

TEST(Texture, ExrGivesItsColours) {
    const ScratchFolder folder;
    const std::vector<float> red{0.25f, 2.0f}, green{0.5f, 0.0f}, blue{1.0f, -1.0f};
    write_exr_file(2, 1, std::vector<ExrChannel>{{"R", red.data()}, {"G", green.data()}, {"B", blue.data()}}, {}, false,
                   folder / "a.exr");
    const Texture texture = read_texture(folder / "a.exr");
    EXPECT_EQ(texture.texels, (std::vector<Vec3>{{0.25f, 0.5f, 1.0f}, {2.0f, 0.0f, -1.0f}}));
}

TEST(Texture, IsInterpolatedAndRepeats) {
    // v is 1 at the top.
    const Texture texture{2, 2, {Vec3(0.0f), Vec3(1.0f), Vec3(2.0f), Vec3(3.0f)}};
    EXPECT_EQ(texture.at({0.25f, 0.75f}), Vec3(0.0f));
    EXPECT_EQ(texture.at({0.75f, 0.25f}), Vec3(3.0f));
    EXPECT_EQ(texture.at({0.5f, 0.5f}), Vec3(1.5f));
    EXPECT_EQ(texture.at({1.25f, -0.25f}), texture.at({0.25f, 0.75f}));
    const Vec3 far = texture.at({3e38f, -3e38f}); // any of its values
    EXPECT_TRUE(far.x >= 0.0f && far.x <= 3.0f);
    EXPECT_EQ(texture.at({0.0f, 0.75f}), Vec3(0.5f)); // between the last and the first column
}

TEST(Texture, OtherFilesAreRefusedByName) {
    const ScratchFolder folder;
    write_bytes(folder / "no.png", "none");
    EXPECT_THROW(read_texture(folder / "no.png"), InputError);
    EXPECT_THROW(read_texture(folder / "missing.png"), InputError);
    const std::string whole = encode_png_file(64, 64, 1, 8, std::vector<std::uint16_t>(64 * 64, 7));
    write_bytes(folder / "cut.png", whole.substr(0, whole.size() - 30));
    EXPECT_THROW(read_texture(folder / "cut.png"), InputError);
}

}
}
