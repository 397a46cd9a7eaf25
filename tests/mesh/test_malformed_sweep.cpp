#include "announced.h"
#include "damages.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/formats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

using namespace alcove;

namespace {

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(input), {}};
}

bool warns(const Mesh& mesh, std::size_t count, std::string_view words) {
    return std::any_of(mesh.warnings.begin(), mesh.warnings.end(), [&](const std::string& warning) {
        return warning.starts_with(grouped(count) + " ") && warning.find(words) != std::string::npos;
    });
}

/// The mesh has everything that the file declares, and warnings count what is invalid.
void check_read(const Mesh& mesh, const std::string& bytes) {
    const Announced announced = announced_by(bytes, mesh.format);
    // Reading joins equal corners of STL.
    const std::size_t vertices = mesh.format == "STL" ? mesh.corners.size() : mesh.vertex_count();
    EXPECT_EQ(vertices, announced.vertices);
    EXPECT_EQ(mesh.face_count(), announced.faces);
    EXPECT_EQ(mesh.face_begin.back(), mesh.corners.size());
    EXPECT_TRUE(std::all_of(mesh.corners.begin(), mesh.corners.end(),
                            [&](std::uint32_t corner) { return corner < mesh.vertex_count(); }));
    const auto finite =
        static_cast<std::size_t>(std::count_if(mesh.positions.begin(), mesh.positions.end(), is_finite));
    EXPECT_TRUE(finite == mesh.vertex_count() || warns(mesh, mesh.vertex_count() - finite, "not finite numbers"));
}

class MalformedSweep : public testing::TestWithParam<const char*> {};

}

TEST_P(MalformedSweep, FilesAreReadInFullOrRefusedInOneLine) {
    const std::string format = GetParam(), name = "damaged." + format;
    std::size_t read = 0, refused = 0;
    for (const auto& seed : std::filesystem::directory_iterator(ALCOVE_MESH_SEEDS "/" + format))
        for_each_damage(bytes_of(seed.path()), [&](const char* damage, const std::string& bytes) {
            SCOPED_TRACE(testing::Message() << seed.path().filename() << ", " << damage << ":\n"
                                            << bytes.substr(0, 2000));
            try {
                check_read(read_bytes(FileBytes(name, bytes)), bytes);
                ++read;
            } catch (const InputError& error) {
                const std::string_view message = error.what();
                EXPECT_TRUE(message.starts_with(name + ": ")) << message;
                EXPECT_EQ(message.find_first_of("\r\n"), std::string_view::npos) << message;
                ++refused;
            }
        });
    std::cout << format << ": " << read + refused << " malformed files, " << refused << " refused\n";
    EXPECT_GE(refused, 400u);
}

INSTANTIATE_TEST_SUITE_P(Formats, MalformedSweep, testing::Values("ply", "obj", "off", "stl"),
                         [](const auto& format) { return std::string(format.param); });
