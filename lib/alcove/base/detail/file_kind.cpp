#include "alcove/base/detail/file_kind.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>

namespace alcove {

const char* special_kind(const struct stat& status) {
    if (S_ISREG(status.st_mode))
        return nullptr;
    return S_ISDIR(status.st_mode)    ? "a folder"
           : S_ISFIFO(status.st_mode) ? "a pipe"
           : S_ISSOCK(status.st_mode) ? "a socket"
                                      : "a device";
}

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}
