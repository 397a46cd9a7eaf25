/// A file or pipe that is open for reading, at most read_limit() bytes of it.
#pragma once

#include <cstddef>
#include <ctime>
#include <filesystem>

namespace alcove {

class InputFile {
  public:
    /// Opens a regular file, or a pipe after waiting for its writer. \throw InputError for anything else, LimitError
    /// for a file that is too large.
    explicit InputFile(const std::filesystem::path& file);

    /// The size that the system reports: 0 for a pipe, and files may grow.
    std::size_t size() const { return size_; }
    /// Reads up to `count` bytes, > 0, after those of the last call. \return how many; 0 at the end. \throw InputError
    /// if the system cannot read the file, LimitError beyond the limit.
    std::size_t read(char* to, std::size_t count);

    // Of a regular file, at any place and on any thread. \throw InputError as well if the file has changed since it was
    // opened: bytes of two versions do not fit each other. A file that was replaced by another one has not changed.
    void read_at(std::size_t offset, char* to, std::size_t count) const;
    /// Lets the system copy up to `count` bytes to the end of an output, if it can. \return how many.
    std::size_t copy_to(int output, std::size_t offset, std::size_t count) const;
    void check_unchanged() const;

  private:
    struct Descriptor {
        explicit Descriptor(int n) : number(n) {}
        ~Descriptor();
        Descriptor(const Descriptor&) = delete;
        Descriptor& operator=(const Descriptor&) = delete;

        int number;
    };
    std::filesystem::path path_;
    Descriptor descriptor_;
    std::size_t size_ = 0;
    std::timespec modified_{};
    std::size_t done_ = 0; ///< bytes read
};

/// For libraries that open the file themselves and seek in it. \throw InputError unless it is a regular file that is
/// empty or whose first byte can be read; LimitError if it is too large.
void check_input_file(const std::filesystem::path& file);

}
