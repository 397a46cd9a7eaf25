/// A file in memory, for readers that only take paths.
#pragma once

#include "checks.h"

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>

namespace alcove::fuzz {

class MemoryFile {
  public:
    explicit MemoryFile(Bytes bytes) : descriptor_(::memfd_create("alcove", MFD_CLOEXEC)) {
        require(descriptor_ >= 0, "a file in memory can be created");
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
            require(written > 0, "a file in memory can be written");
            done += static_cast<std::size_t>(written);
        }
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}
