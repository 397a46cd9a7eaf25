#include "scratch_files.h"

#include "alcove/base/types.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>

using namespace alcove;
using Write = ScratchFiles;

namespace {

Mesh triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
    return mesh;
}

template <class Error>
std::string message_of(const Mesh& mesh, const std::filesystem::path& file) {
    try {
        write_mesh(mesh, file);
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

/// Limits the size of files while it exists, to simulate a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &previous_);
        const rlimit limit{bytes, previous_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &previous_);
        std::signal(SIGXFSZ, previous_handler_);
    }

  private:
    rlimit previous_{};
    void (*previous_handler_)(int);
};

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}

TEST_F(Write, OtherExtensionsAreRefusedByName) {
    for (const char* name : {"out.stl", "out.off", "out", "out.ply.gz"}) {
        const std::string message = message_of<InputError>(triangle(), path(name));
        EXPECT_NE(message.find(name), std::string::npos) << message;
        EXPECT_NE(message.find(".ply, .obj, .glb or .gltf"), std::string::npos) << message;
        EXPECT_FALSE(std::filesystem::exists(path(name)));
    }
    EXPECT_NO_THROW(write_mesh(triangle(), path("OUT.PLY")));
}

TEST_F(Write, AFolderAndAMissingFolderAreNamed) {
    std::filesystem::create_directory(path("folder.ply"));
    EXPECT_NE(message_of<IoError>(triangle(), path("folder.ply")).find("is a folder"), std::string::npos);
    EXPECT_NE(message_of<IoError>(triangle(), path("no/such/out.ply")).find("its folder does not exist"),
              std::string::npos);
    EXPECT_NE(message_of<IoError>(triangle(), "/dev/null/out.ply").find("Not a directory"), std::string::npos);
    std::filesystem::create_symlink("/dev/null", path("null.ply"));
    EXPECT_NE(message_of<InputError>(triangle(), path("null.ply")).find("is a device"), std::string::npos);
}

TEST_F(Write, AnUnwritableFolderIsNamed) {
    if (::geteuid() == 0)
        GTEST_SKIP() << "the superuser may write everywhere";
    std::filesystem::create_directory(path("locked"));
    std::filesystem::permissions(path("locked"),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    EXPECT_NE(message_of<IoError>(triangle(), path("locked/out.ply")).find("Permission denied"), std::string::npos);
    std::filesystem::permissions(path("locked"), std::filesystem::perms::owner_all);
}

TEST_F(Write, AFullDiskLeavesTheOldFileAndNoOther) {
    Mesh mesh = triangle();
    mesh.positions.resize(100000, Vec3d(0.25));
    for (const char* name : {"out.ply", "out.obj"}) {
        write(name, "the old file");
        const FileSizeLimit limit(4096);
        EXPECT_NE(message_of<IoError>(mesh, path(name)).find("cannot be written: File too large"), std::string::npos);
        EXPECT_EQ(bytes_of(name), "the old file");
    }
    EXPECT_EQ(files_in(path("")), 2u);
}

TEST_F(Write, ReplacesTheFileALinkPointsToAndKeepsItsPermissions) {
    write("real.ply", "old");
    std::filesystem::permissions(path("real.ply"),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    std::filesystem::create_symlink("real.ply", path("link.ply"));
    write_mesh(triangle(), path("link.ply"));
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.ply")));
    EXPECT_EQ(read_mesh(path("real.ply")).positions, triangle().positions);
    EXPECT_EQ(std::filesystem::status(path("real.ply")).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_EQ(files_in(path("")), 2u);
}

TEST_F(Write, TheInputMayBeTheOutput) {
    write_mesh(triangle(), path("mesh.ply"));
    Mesh mesh = read_mesh(path("mesh.ply"));
    mesh.set_attribute({"ao", 1, {0, 0.5f, 1}});
    write_mesh(mesh, path("mesh.ply"));
    EXPECT_NE(header_of("mesh.ply").find("property float ao"), std::string::npos);
    EXPECT_EQ(read_mesh(path("mesh.ply")).corners, mesh.corners);
}

TEST_F(Write, ColoursOfAnotherCountAreRefused) {
    Mesh mesh = triangle();
    mesh.added_colors = {Color{}};
    EXPECT_THROW(write_mesh(mesh, path("out.ply")), std::invalid_argument);
}
