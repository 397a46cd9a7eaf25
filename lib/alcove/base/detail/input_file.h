/// A file or pipe that is open for reading. At most read_limit() bytes of it can be read.
#pragma once

#include <cstddef>
#include <ctime>
#include <filesystem>

namespace alcove {

class InputFile {
  public:
    /// Opens a regular file, or a pipe once it has a writer. \throw InputError for anything else, LimitError for a file
    /// that is too large.
    explicit InputFile(const std::filesystem::path& file);

    /// The size that the system reported when the file was opened; 0 for a pipe. The file may have grown since.
    std::size_t size() const { return size_; }
    /// Reads the next bytes, at most `count` (> 0). \return how many were read; 0 at the end. \throw InputError if the
    /// system cannot read the file, LimitError if the bytes read so far exceed the limit.
    std::size_t read(char* to, std::size_t count);

    // The next functions need a regular file. They work at any offset and on any thread. read_at() and
    // check_unchanged() also \throw InputError if the contents of the file have changed since it was opened, because
    // bytes of two versions do not fit together. Replacing the file by another one does not change its contents.
    void read_at(std::size_t offset, char* to, std::size_t count) const;
    /// Lets the system copy up to `count` bytes to the file position of the descriptor `output`. \return how many were
    /// copied; 0 if the system cannot.
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
    std::size_t done_ = 0; ///< bytes that read() has returned
};

/// Checks a file for libraries that open it themselves and seek in it. \throw InputError if the file is not a regular
/// one or its first byte cannot be read (an empty file is accepted), LimitError if it is too large.
void check_input_file(const std::filesystem::path& file);

}
