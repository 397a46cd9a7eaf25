#include "alcove/mesh/formats/file_part.h"

#include <algorithm>

namespace alcove {

FilePart FilePart::part(std::size_t begin, std::size_t size) const {
    if (file_ != nullptr)
        return {*file_, begin_ + begin, size};
    return FilePart(std::string_view(bytes_, size_).substr(begin, size));
}

std::string_view FilePart::read(std::string& buffer) const {
    if (file_ == nullptr)
        return {bytes_, size_};
    buffer.resize(size_);
    read_to(buffer.data());
    return buffer;
}

std::string FilePart::read() const {
    std::string buffer;
    return std::string(read(buffer));
}

void FilePart::read_to(char* to) const {
    if (file_ != nullptr)
        file_->read_at(begin_, to, size_);
    else
        std::copy_n(bytes_, size_, to);
}

void FilePart::write_to(AtomicFile& output) const {
    if (file_ != nullptr)
        output.copy(*file_, begin_, size_);
    else
        output.write({bytes_, size_});
}

}
