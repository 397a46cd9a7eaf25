#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/ply/ply_parse.h"
#include "alcove/mesh/formats/text_scanner.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace alcove {
namespace {

/// Appends values to the rows of an element through a block that stays in the cache.
class RowBuffer {
  public:
    /// The rows take at most `max_bytes`.
    RowBuffer(PlyElement& element, std::size_t max_bytes) : element_(element), max_bytes_(max_bytes) {}

    /// Memory for the next value, of at most 8 bytes; valid until the next call.
    std::byte* extend(std::size_t bytes) {
        if (block_.size() - used_ < bytes)
            flush();
        used_ += bytes;
        return block_.data() + used_ - bytes;
    }
    void end_row() { ++ended_; }
    /// Moves all rows to the element.
    void finish() {
        flush();
        element_.keep(std::move(rows_));
    }

  private:
    void flush() {
        // Estimate the total size from the first rows, with a margin, because growing the array would copy all rows.
        if (rows_.empty() && ended_ > 0)
            reserve_huge(rows_, std::min(max_bytes_, used_ * element_.count / ended_ * 9 / 8));
        rows_.insert(rows_.end(), block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(used_));
        used_ = 0;
    }

    PlyElement& element_;
    std::size_t max_bytes_;
    std::vector<std::byte> rows_;
    std::array<std::byte, 1 << 16> block_;
    std::size_t used_ = 0, ended_ = 0;
};

class TextRows {
  public:
    TextRows(const FileBytes& file, const char* body) : text_(file, body) {}

    void read(PlyElement& element) {
        const std::size_t width = element.properties.size();
        if (width == 0)
            return;
        // A value takes at least a digit and a separator, which may be missing after the last value of the file.
        text_.at_end();
        if (element.count > (text_.bytes_left() + 1) / (2 * width))
            text_.fail(grouped(element.count) + " rows of element " + in_quotes(element.name) +
                       " are declared but only " + grouped(text_.bytes_left()) +
                       " bytes follow; copy or export the file again");
        RowBuffer rows(element, (text_.bytes_left() + 1) / 2 * sizeof(double));
        for (std::size_t row = 0; row < element.count; ++row) {
            for (const PlyProperty& property : element.properties)
                if (property.count_type)
                    read_list(property, rows);
                else
                    read_value(property.type, property.name.c_str(), rows.extend(size_of(property.type)));
            if (!text_.at_line_end())
                text_.fail("more values on the line than element " + in_quotes(element.name) +
                           " has properties; export the file again");
            rows.end_row();
        }
        rows.finish();
    }

    const char* at() const { return text_.at(); }
    std::size_t bytes_left() { return text_.at_end() ? 0 : text_.bytes_left(); }

  private:
    void read_list(const PlyProperty& property, RowBuffer& rows) {
        std::byte* const at = rows.extend(size_of(*property.count_type));
        read_value(*property.count_type, property.name.c_str(), at);
        const std::int64_t items = integer_at(at, *property.count_type);
        if (items < 0 || static_cast<std::size_t>(items) > (text_.bytes_left() + 1) / 2)
            text_.fail("a list " + in_quotes(property.name) + " of " + std::to_string(items) +
                       " items does not fit the rest of the file; copy or export it again");
        const std::size_t size = size_of(property.type);
        for (std::int64_t i = 0; i < items; ++i)
            read_value(property.type, property.name.c_str(), rows.extend(size));
    }

    void read_value(PlyType type, const char* name, std::byte* to) {
        switch (type) {
        case PlyType::int8:
            return store<std::int8_t>(name, to);
        case PlyType::uint8:
            return store<std::uint8_t>(name, to);
        case PlyType::int16:
            return store<std::int16_t>(name, to);
        case PlyType::uint16:
            return store<std::uint16_t>(name, to);
        case PlyType::int32:
            return store<std::int32_t>(name, to);
        case PlyType::uint32:
            return store<std::uint32_t>(name, to);
        case PlyType::float32:
            return store<float>(name, to);
        case PlyType::float64:
            return store<double>(name, to);
        }
    }

    template <class T>
    void store(const char* name, std::byte* to) {
        T value;
        if constexpr (std::is_floating_point_v<T>) {
            value = text_.number<T>(name);
        } else {
            const std::int64_t wide = text_.integer(name);
            if (wide < std::numeric_limits<T>::min() || wide > std::numeric_limits<T>::max())
                text_.fail(std::to_string(wide) + " does not fit the type that the header declares for '" + name +
                           "'; export the file again");
            value = static_cast<T>(wide);
        }
        std::memcpy(to, &value, sizeof value);
    }

    TextScanner text_;
};

class BinaryRows {
  public:
    BinaryRows(const FileBytes& file, const char* body, bool swapped) : file_(file), at_(body), swapped_(swapped) {}

    void read(PlyElement& element) {
        if (element.properties.empty())
            return;
        const std::size_t smallest = element.smallest_row();
        if (element.count > bytes_left() / smallest)
            file_.fail_at_byte(at_, grouped(element.count) + " rows of element " + in_quotes(element.name) +
                                        " take at least " + grouped(smallest) + " bytes each but only " +
                                        grouped(bytes_left()) + " bytes follow; copy or export the file again");
        const char* const end = element.has_lists() ? end_of_rows(element) : at_ + element.count * smallest;
        element.rows = std::as_bytes(std::span(at_, end));
        element.keeper = file_.keeper();
        at_ = end;
        if (swapped_)
            swap_rows(element);
    }

    const char* at() const { return at_; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(file_.end() - at_); }

  private:
    const char* end_of_rows(const PlyElement& element) const {
        const char* at = at_;
        for (std::size_t row = 0; row < element.count; ++row)
            for (const PlyProperty& property : element.properties) {
                const std::size_t head = size_of(property.count_type.value_or(property.type));
                if (static_cast<std::size_t>(file_.end() - at) < head)
                    file_.fail_at_byte(file_.end(), "the file ends early: row " + grouped(row) + " of element " +
                                                        in_quotes(element.name) +
                                                        " is cut off; copy or export it again");
                if (property.count_type) {
                    const std::int64_t items = count_at(at, *property.count_type);
                    const std::size_t left = static_cast<std::size_t>(file_.end() - at) - head;
                    if (items < 0 || static_cast<std::size_t>(items) > left / size_of(property.type))
                        file_.fail_at_byte(at, "a list " + in_quotes(property.name) + " of " + std::to_string(items) +
                                                   " items does not fit the rest of the file; copy or export it again");
                    at += static_cast<std::size_t>(items) * size_of(property.type);
                }
                at += head;
            }
        return at;
    }

    std::int64_t count_at(const char* at, PlyType type) const {
        std::byte bytes[sizeof(double)];
        const std::size_t size = size_of(type);
        std::memcpy(bytes, at, size);
        if (swapped_)
            std::reverse(bytes, bytes + size);
        return integer_at(bytes, type);
    }

    static void swap_rows(PlyElement& element) {
        std::vector<std::byte> rows(element.rows.begin(), element.rows.end());
        std::byte* at = rows.data();
        const auto swap_value = [&at](std::size_t size) {
            std::reverse(at, at + size);
            at += size;
        };
        for (std::size_t row = 0; row < element.count; ++row)
            for (const PlyProperty& property : element.properties) {
                std::int64_t items = 1;
                if (property.count_type) {
                    swap_value(size_of(*property.count_type));
                    items = integer_at(at - size_of(*property.count_type), *property.count_type);
                }
                for (; items > 0; --items)
                    swap_value(size_of(property.type));
            }
        element.keep(std::move(rows));
    }

    const FileBytes& file_;
    const char* at_;
    bool swapped_;
};

std::size_t read_all(auto rows, PlyHeader& header) {
    for (PlyElement& element : header.document.elements) {
        header.element_begin.push_back(rows.at());
        rows.read(element);
    }
    return rows.bytes_left();
}

}

std::size_t parse_ply_rows(const FileBytes& file, PlyHeader& header) {
    if (header.format == PlyFormat::ascii)
        return read_all(TextRows(file, header.body), header);
    return read_all(BinaryRows(file, header.body, header.format == PlyFormat::big_endian), header);
}

void fail_in_row(const FileBytes& file, const PlyHeader& header, const PlyElement& element, std::size_t row,
                 std::size_t offset, const std::string& message) {
    const auto number = static_cast<std::size_t>(&element - header.document.elements.data());
    if (header.format != PlyFormat::ascii)
        file.fail_at_byte(header.element_begin[number] + offset, message);
    TextScanner text(file, header.element_begin[number]);
    for (; row > 0 && !text.at_end(); --row)
        text.next_line();
    text.at_end();
    text.fail(message);
}

}
