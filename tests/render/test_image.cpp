#include "alcove/render/image.h"

#include "alcove/base/types.h"
#include "scratch_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <set>
#include <sstream>

namespace alcove {
namespace {

Image pattern(int width, int height, PassSet wanted = standard_passes) {
    Image image(width, height, wanted);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto t = static_cast<float>(i);
        const auto set = [&](Pass pass, auto& values, const auto& value) {
            if (wanted.has(pass))
                values[i] = value;
        };
        image.alpha[i] = i % 3 == 0 ? 0.0f : 1.0f;
        set(Pass::beauty, image.color, Vec3(0.01f * t, 0.5f, 1.0f / (1.0f + t)));
        set(Pass::ao, image.ao, 1.0f / (2.0f + t));
        set(Pass::convexity, image.convexity, 1.0f / (3.0f + t));
        set(Pass::shadow, image.shadow, 1.0f / (4.0f + t));
        set(Pass::steps, image.steps, 0.25f * t);
        set(Pass::object, image.object, static_cast<float>(i % 3));
        set(Pass::depth, image.depth, i % 3 == 0 ? far_depth : 100.0f + 0.001f * t);
        set(Pass::normal, image.normal, glm::normalize(Vec3(t, 1.0f, -2.0f)));
        set(Pass::position, image.position, Vec3(t, -t, 0.1f * t));
    }
    return image;
}

std::vector<float> channel(Imf::InputFile& file, const char* name, const Image& image) {
    std::vector<float> values(image.pixels());
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                   sizeof(float) * static_cast<std::size_t>(image.width)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, image.height - 1);
    return values;
}

TEST(Exr, HoldsEveryPass) {
    const ScratchFolder folder;
    const Image image = pattern(13, 7);
    write_exr(image, folder / "a.exr", {});
    Imf::InputFile file((folder / "a.exr").c_str());
    const Imath::Box2i window = file.header().dataWindow();
    EXPECT_EQ(window.max.x - window.min.x + 1, 13);
    EXPECT_EQ(window.max.y - window.min.y + 1, 7);
    EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);

    std::set<std::string> names;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c)
        names.insert(c.name());
    const std::set<std::string> expected{"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "AO.R", "AO.G", "AO.B"};
    EXPECT_EQ(names, expected);

    const auto r = channel(file, "R", image), b = channel(file, "B", image), a = channel(file, "A", image);
    const auto z = channel(file, "Z", image), ny = channel(file, "N.Y", image), nz = channel(file, "N.Z", image);
    const auto ao_r = channel(file, "AO.R", image), ao_b = channel(file, "AO.B", image);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        EXPECT_NEAR(r[i], image.color[i].x, 1e-3f * image.color[i].x);
        EXPECT_NEAR(b[i], image.color[i].z, 1e-3f * image.color[i].z);
        EXPECT_EQ(a[i], image.alpha[i]);
        EXPECT_EQ(z[i], image.depth[i]); // float: exact
        EXPECT_EQ(ny[i], image.normal[i].y);
        EXPECT_EQ(nz[i], image.normal[i].z);
        EXPECT_NEAR(ao_r[i], image.ao[i], 1e-3f * image.ao[i]);
        EXPECT_EQ(ao_b[i], ao_r[i]);
    }
}

PassSet everything() {
    PassSet all;
    for (const PassInfo& info : all_passes)
        all = all | info.pass;
    return all;
}

std::set<std::string> channels_of(const std::filesystem::path& file) {
    const Imf::InputFile opened(file.c_str());
    std::set<std::string> names;
    for (auto c = opened.header().channels().begin(); c != opened.header().channels().end(); ++c)
        names.insert(c.name());
    return names;
}

TEST(Exr, HasTheChannelsThatEachPassNames) {
    const ScratchFolder folder;
    for (const PassInfo& info : all_passes) {
        write_exr(pattern(5, 4, info.pass), folder / "a.exr", {});
        std::set<std::string> expected{"A"};
        std::istringstream words{std::string(info.channels)};
        for (std::string word; words >> word;)
            expected.insert(word);
        EXPECT_EQ(channels_of(folder / "a.exr"), expected) << info.name;
    }
    write_exr(pattern(5, 4, everything()), folder / "a.exr", {});
    EXPECT_EQ(channels_of(folder / "a.exr").size(), 22u);
}

TEST(Exr, KeepsColoursInSinglePrecisionWhereAsked) {
    const ScratchFolder folder;
    const Image image = pattern(13, 7, everything());
    write_exr(image, folder / "a.exr", {}, Precision::single);
    Imf::InputFile file((folder / "a.exr").c_str());
    EXPECT_EQ(channel(file, "AO.G", image), image.ao);
    EXPECT_EQ(channel(file, "Shadow.R", image), image.shadow);
    EXPECT_EQ(channel(file, "Convexity.B", image), image.convexity);
    EXPECT_EQ(channel(file, "Steps.V", image), image.steps);
    EXPECT_EQ(channel(file, "Object.V", image), image.object);
    EXPECT_EQ(channel(file, "R", image)[7], image.color[7].x);
    EXPECT_EQ(channel(file, "P.Y", image)[7], image.position[7].y);
}

TEST(Images, HoldOnlyTheirPasses) {
    const Image image(4, 3, Pass::ao);
    EXPECT_EQ(image.alpha.size(), 12u);
    EXPECT_EQ(image.ao.size(), 12u);
    EXPECT_TRUE(image.color.empty() && image.depth.empty() && image.position.empty());
    EXPECT_EQ(Image::bytes_per_pixel(Pass::ao), 8.0);
    EXPECT_EQ(Image::bytes_per_pixel(Pass::beauty | Pass::normal), 28.0);
}

TEST(Exr, HeaderTellsTheCamera) {
    const ScratchFolder folder;
    ImageHeader description;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) {
            description.world_to_camera[c][r] = 1.0 + 4 * c + r;
            description.world_to_ndc[c][r] = -0.5 * (4 * c + r);
        }
    description.screen_window_width = 1.25;
    description.software = "a program 1.2.3";
    description.comments = "what was done";
    write_exr(pattern(4, 3), folder / "a.exr", description);
    const Imf::InputFile file((folder / "a.exr").c_str());
    const Imf::Header& header = file.header();
    ASSERT_TRUE(Imf::hasWorldToCamera(header));
    ASSERT_TRUE(Imf::hasWorldToNDC(header));
    ASSERT_TRUE(Imf::hasComments(header));
    EXPECT_EQ(Imf::comments(header), "what was done");
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("software").value(), "a program 1.2.3");
    EXPECT_EQ(header.screenWindowWidth(), 1.25f);

    // Matrices of the file act on row vectors; ours act on column vectors.
    const glm::dvec4 ours = description.world_to_camera * glm::dvec4(1.0, -2.0, 3.0, 1.0);
    const Imath::M44f& m = Imf::worldToCamera(header);
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(1.0f * m[0][c] - 2.0f * m[1][c] + 3.0f * m[2][c] + m[3][c], static_cast<float>(ours[c]));
    EXPECT_EQ(Imf::worldToNDC(header)[2][3], static_cast<float>(description.world_to_ndc[2][3]));
}

struct Decoded {
    int width, height;
    std::vector<std::uint8_t> rgb;
    const std::uint8_t* at(int x, int y) const {
        return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
    }
};

Decoded decode(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&png, file.c_str())) << png.message;
    png.format = PNG_FORMAT_RGB;
    Decoded image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
    image.rgb.resize(PNG_IMAGE_SIZE(png));
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr)) << png.message;
    return image;
}

TEST(Png, HasSignatureAndSize) {
    const ScratchFolder folder;
    for (const auto& [pass, name, channels, summary] : all_passes) {
        write_png(pattern(33, 21, pass), folder / "a.png", pass);
        EXPECT_EQ(bytes_of(folder / "a.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
        const Decoded image = decode(folder / "a.png");
        EXPECT_EQ(image.width, 33);
        EXPECT_EQ(image.height, 21);
    }
}

TEST(Png, ShowsThePassThatIsAskedFor) {
    const ScratchFolder folder;
    Image image(2, 1);
    image.alpha = {1.0f, 1.0f};
    image.color = {{0.0f, 1.0f, 0.214f}, {2.0f, -1.0f, 0.5f}};
    image.ao = {0.0f, 0.214f};
    image.normal = {{0.0f, 0.0f, 1.0f}, {-1.0f, 0.0f, 0.0f}};
    image.depth = {5.0f, 9.0f};
    const auto pixels = [&](Pass pass) {
        write_png(image, folder / "a.png", pass);
        return decode(folder / "a.png");
    };
    // Linear light of 0.214 is 0.5 in sRGB.
    EXPECT_EQ(pixels(Pass::beauty).rgb, (std::vector<std::uint8_t>{0, 255, 127, 255, 0, 188}));
    EXPECT_EQ(pixels(Pass::ao).rgb, (std::vector<std::uint8_t>{0, 0, 0, 127, 127, 127}));
    EXPECT_EQ(pixels(Pass::normal).rgb, (std::vector<std::uint8_t>{128, 128, 255, 0, 128, 128}));
    const Decoded depth = pixels(Pass::depth);
    EXPECT_EQ(depth.at(0, 0)[0], 255);
    EXPECT_LT(depth.at(1, 0)[0], 128);
    EXPECT_GT(depth.at(1, 0)[0], 0);
}

TEST(Png, BackdropIsLightAndCoveredByAlpha) {
    const ScratchFolder folder;
    Image image(1, 3);
    image.alpha[1] = 0.5f; // half of it black
    write_png(image, folder / "a.png", Pass::beauty);
    const Decoded shown = decode(folder / "a.png");
    for (const int y : {0, 2}) {
        EXPECT_GT(shown.at(0, y)[0], 150);
        EXPECT_EQ(shown.at(0, y)[0], shown.at(0, y)[2]);
    }
    EXPECT_LT(shown.at(0, 1)[0], shown.at(0, 2)[0]);
    EXPECT_GT(shown.at(0, 1)[0], 50);
}

TEST(Png, TheBackgroundOfAoAndShadowIsOpen) {
    const ScratchFolder folder;
    Image image(1, 3, Pass::ao | Pass::shadow);
    image.alpha[1] = 0.5f; // half of it black
    for (const Pass pass : {Pass::ao, Pass::shadow}) {
        write_png(image, folder / "a.png", pass);
        const std::vector<std::uint8_t> expected{255, 255, 255, 188, 188,
                                                 188, 255, 255, 255}; // 188: linear 0.5 in sRGB
        EXPECT_EQ(decode(folder / "a.png").rgb, expected);
    }
}

TEST(ImageFiles, AreWrittenWholeOrNotAtAll) {
    const ScratchFolder folder;
    const Image image = pattern(5, 4);
    EXPECT_THROW(write_png(image, folder / "missing/a.png", Pass::beauty), IoError);
    EXPECT_THROW(write_exr(image, folder / "missing/a.exr", {}), IoError);
    write_exr(image, folder / "a.exr", {});
    write_png(image, folder / "a.png", Pass::beauty);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / ""))
        ++files;
    EXPECT_EQ(files, 2u); // no temporary file is left
}

}
}
