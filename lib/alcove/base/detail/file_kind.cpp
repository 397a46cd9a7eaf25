#include "alcove/base/detail/file_kind.h"

#include <sys/stat.h>

namespace alcove {

const char* special_kind(const struct stat& status) {
    if (S_ISREG(status.st_mode))
        return nullptr;
    return S_ISDIR(status.st_mode)    ? "a folder"
           : S_ISFIFO(status.st_mode) ? "a pipe"
           : S_ISSOCK(status.st_mode) ? "a socket"
                                      : "a device";
}

}
