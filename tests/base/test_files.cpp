/// Files that are not regular files, cannot be read, or are too large; and links.
#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/input_file.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/types.h"
#include "mesh/scratch_files.h"

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace alcove {
namespace {

class Files : public ScratchFiles {
  protected:
    ~Files() override { limit_reading(0.0); }

    void make_pipe(const std::string& name) const { ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0); }
    void make_socket(const std::string& name) const {
        const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strncpy(address.sun_path, path(name).c_str(), sizeof address.sun_path - 1);
        ASSERT_EQ(::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        ::close(descriptor);
    }
    void link(const std::string& target, const std::string& name) const {
        std::filesystem::create_symlink(target, path(name));
    }
    template <class Error, class Work>
    static std::string message_of(const Work& work) {
        try {
            work();
        } catch (const Error& error) {
            return error.what();
        }
        return "nothing was thrown";
    }
    std::string refusal_of_input(const std::string& name) const {
        return message_of<InputError>([&] { check_input_file(path(name)); });
    }
    std::string refusal_of_output(const std::string& name) const {
        return message_of<InputError>([&] { const AtomicFile file(path(name)); });
    }
    static void expect(const std::string& message, std::string_view part) {
        EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    }
};

TEST_F(Files, InputsOfOtherKindsAreNamed) {
    make_pipe("pipe");
    make_socket("socket");
    std::filesystem::create_directory(path("folder"));
    link("/dev/null", "device");
    link("loop", "loop");
    link("missing", "dangling");
    expect(refusal_of_input("pipe"), "pipe: is a pipe");
    expect(refusal_of_input("socket"), "socket: is a socket");
    expect(refusal_of_input("folder"), "folder: is a folder");
    expect(refusal_of_input("device"), "device: is a device");
    expect(refusal_of_input("loop"), "loop: cannot be opened: Too many levels of symbolic links");
    expect(refusal_of_input("dangling"), "dangling: cannot be opened: No such file");
    write("file", "bytes");
    link("file", "link");
    EXPECT_NO_THROW(check_input_file(path("link")));
}

/// The memory of a process is a regular file whose first page cannot be read.
TEST_F(Files, AReadThatFailsEndsAtOnce) {
    link("/proc/self/mem", "memory");
    expect(refusal_of_input("memory"), "memory: cannot be read: Input/output error");
    InputFile file(path("memory"));
    char byte = 0;
    EXPECT_THROW(file.read(&byte, 1), InputError);
}

TEST_F(Files, ALargeFileIsRefusedBeforeItIsRead) {
    write("sparse", "bytes");
    std::filesystem::resize_file(path("sparse"), std::uintmax_t{1} << 40);
    limit_reading(2e9);
    const std::string message = message_of<LimitError>([&] { const InputFile file(path("sparse")); });
    expect(message, "sparse: is larger than 2 GB");
    expect(message, "--max-read");
    std::filesystem::resize_file(path("sparse"), 2'000'000'000);
    EXPECT_EQ(InputFile(path("sparse")).size(), 2'000'000'000u);
}

TEST_F(Files, AFileThatOutgrowsTheLimitIsRefusedWhileItIsRead) {
    write("growing", "0123456789");
    limit_reading(10);
    InputFile file(path("growing"));
    write("growing", "0123456789+");
    std::array<char, 10> bytes{};
    EXPECT_EQ(file.read(bytes.data(), bytes.size()), 10u);
    EXPECT_THROW(file.read(bytes.data(), 1), LimitError);
}

TEST_F(Files, AFileThatChangedIsNotReadAtAPlace) {
    write("file", "0123456789");
    const InputFile file(path("file"));
    std::array<char, 4> bytes{};
    file.read_at(3, bytes.data(), bytes.size());
    EXPECT_EQ(std::string_view(bytes.data(), bytes.size()), "3456");
    write("other", "new");
    std::filesystem::rename(path("other"), path("file")); // the old file is still open
    EXPECT_NO_THROW(file.read_at(0, bytes.data(), bytes.size()));
    const InputFile shrinking(path("file"));
    write("file", "ne");
    expect(message_of<InputError>([&] { shrinking.read_at(0, bytes.data(), 1); }),
           "file: was changed while it was being processed; run again");
}

/// Also from a file in memory, whose file system the system does not copy from by itself.
TEST_F(Files, PartsOfFilesAreCopied) {
    std::string bytes(3'000'000, ' ');
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<char>(i * i / 1000);
    const int in_memory = ::memfd_create("from", 0);
    ASSERT_EQ(::write(in_memory, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    for (const std::filesystem::path& from :
         {write("from", bytes), std::filesystem::path("/proc/self/fd") / std::to_string(in_memory)}) {
        AtomicFile to(path("to"));
        to.write("head");
        to.copy(InputFile(from), 12'345, 2'900'000);
        to.write("tail");
        to.commit();
        EXPECT_TRUE(bytes_of("to") == "head" + bytes.substr(12'345, 2'900'000) + "tail");
    }
    ::close(in_memory);
}

TEST_F(Files, OutputsOfOtherKindsAreRefusedAndStay) {
    make_pipe("pipe");
    make_socket("socket");
    link("/dev/null", "device");
    link("loop", "loop");
    link("missing", "dangling");
    link("no/such/folder/file", "far");
    expect(refusal_of_output("pipe"), "pipe: is a pipe, not a file");
    expect(refusal_of_output("socket"), "socket: is a socket, not a file");
    expect(refusal_of_output("device"), "device: is a device, not a file");
    expect(refusal_of_output("loop"), "loop: is a link that leads back to itself");
    expect(refusal_of_output("dangling"), "dangling: is a link to missing, which does not exist");
    expect(refusal_of_output("far"), "far: is a link to no/such/folder/file, which does not exist");
    EXPECT_EQ(std::filesystem::read_symlink(path("dangling")), "missing");
    EXPECT_FALSE(std::filesystem::exists(path("missing")));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("")), {}), 6);
}

/// A chain of links, the last of which is in another folder.
TEST_F(Files, OutputsThatAreLinksReplaceTheFileAtTheirEnd) {
    std::filesystem::create_directory(path("other"));
    write("other/real", "old");
    link("other/second", "first");
    link("real", "other/second");
    AtomicFile file(path("first"));
    file.write("new");
    EXPECT_EQ(bytes_of("other/real"), "old");
    file.commit();
    EXPECT_EQ(bytes_of("other/real"), "new");
    EXPECT_EQ(bytes_of("first"), "new");
    EXPECT_EQ(std::filesystem::read_symlink(path("first")), "other/second");
    EXPECT_EQ(std::filesystem::read_symlink(path("other/second")), "real");
}

}
}
