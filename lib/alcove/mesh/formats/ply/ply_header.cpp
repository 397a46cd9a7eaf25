#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/ply/ply_parse.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <algorithm>
#include <charconv>

namespace alcove {
namespace {

constexpr std::size_t longest_line = 65536;
constexpr std::size_t most_names =
    4096; // elements, or properties of one element: the search for duplicates is quadratic

std::string_view without_blanks_around(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\v\f";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Removes the first word of `line` and the blanks around it. Returns the word, which is empty at the end of the line.
std::string_view take_word(std::string_view& line) {
    line = without_blanks_around(line);
    const std::string_view word = line.substr(0, std::min(line.find_first_of(" \t\v\f"), line.size()));
    line = without_blanks_around(line.substr(word.size()));
    return word;
}

class HeaderParser {
  public:
    explicit HeaderParser(const FileBytes& file) : file_(file), at_(without_byte_order_mark(file.view()).data()) {
        const std::string_view start = file.view().substr(0, longest_line);
        const std::size_t first_end = start.find_first_of("\r\n");
        // CR alone ends lines only if it ends the first one: binary rows may begin with LF.
        if (first_end != std::string_view::npos && start[first_end] == '\r' &&
            !(first_end + 1 < start.size() && start[first_end + 1] == '\n'))
            line_end_ = '\r';
    }

    PlyHeader parse() {
        next_line();
        if (without_blanks_around(line_) != "ply")
            fail("a PLY file begins with a line 'ply'");
        for (next_line(); without_blanks_around(line_) != "end_header"; next_line())
            parse_line();
        if (!has_format_)
            fail("the header has no format line; add 'format ascii 1.0' or the binary one that fits");
        header_.body = at_;
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { file_.fail_at_line(line_.data(), message); }

    void next_line() {
        const char* const limit =
            std::min(file_.end(), at_ + std::min<std::ptrdiff_t>(longest_line, file_.end() - at_));
        const char* const end = std::find(at_, limit, line_end_);
        line_ = {at_, static_cast<std::size_t>(end - at_)};
        if (end == limit && end != file_.end())
            fail("a header line is longer than " + grouped(longest_line) + " bytes; is end_header missing?");
        const bool last = without_blanks_around(line_) == "end_header";
        if (end == file_.end() && !last)
            fail("the file ends within the header: end_header is missing; copy or export it again");
        at_ = end == file_.end() ? end : end + 1;
    }

    void parse_line() {
        std::string_view rest = line_;
        const std::string_view keyword = take_word(rest);
        if (keyword.empty())
            return;
        if (keyword == "comment" || keyword == "obj_info")
            header_.document.comments.emplace_back(line_.substr(0, line_.find_last_not_of('\r') + 1));
        else if (keyword == "format")
            parse_format(rest);
        else if (keyword == "element")
            parse_element(rest);
        else if (keyword == "property")
            parse_property(rest);
        else
            fail(in_quotes(keyword) +
                 " is not a keyword of a PLY header; is the header damaged or end_header missing?");
    }

    void parse_format(std::string_view rest) {
        if (has_format_)
            fail("a second format line; remove one");
        has_format_ = true;
        const std::string_view name = take_word(rest);
        if (rest != "1.0")
            fail("the format line must read 'format NAME 1.0'");
        if (name == "ascii")
            header_.format = PlyFormat::ascii;
        else if (name == "binary_little_endian")
            header_.format = PlyFormat::little_endian;
        else if (name == "binary_big_endian")
            header_.format = PlyFormat::big_endian;
        else
            fail(in_quotes(name) + " is not a PLY format; these are ascii, binary_little_endian and binary_big_endian");
    }

    /// The name comes before the count and may contain blanks.
    void parse_element(std::string_view rest) {
        const std::size_t last_blank = rest.find_last_of(" \t\v\f");
        if (last_blank == std::string_view::npos)
            fail("an element line must read 'element NAME COUNT'");
        const std::string_view name = without_blanks_around(rest.substr(0, last_blank));
        const std::string_view number = rest.substr(last_blank + 1);
        std::size_t count = 0;
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count);
        if (error != std::errc() || end != number.data() + number.size())
            fail(in_quotes(number) + " is not a number of elements; export the file again");
        std::vector<PlyElement>& elements = header_.document.elements;
        if (header_.document.find(name) != nullptr)
            fail("a second element " + in_quotes(name) + "; remove one");
        if (elements.size() == most_names)
            fail("more than " + grouped(most_names) + " elements; export fewer");
        elements.push_back({std::string(name), count, {}, {}});
        header_.element_line.push_back(line_.data());
    }

    /// The name is the rest of the line, which may contain blanks.
    void parse_property(std::string_view rest) {
        if (header_.document.elements.empty())
            fail("a property before the first element; is an element line missing?");
        std::string_view type = take_word(rest), count_type;
        const bool is_list = type == "list";
        if (is_list) {
            count_type = take_word(rest);
            type = take_word(rest);
        }
        if (rest.empty())
            fail("a property line must read 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        PlyElement& element = header_.document.elements.back();
        PlyProperty property{std::string(rest), type_named(type), {}};
        if (is_list) {
            property.count_type = type_named(count_type);
            if (!is_integral(*property.count_type))
                fail("the count of a list cannot be of type " + in_quotes(count_type) + "; export the file again");
        }
        if (element.find(property.name) != nullptr)
            fail("a second property " + in_quotes(property.name) + " of element " + in_quotes(element.name) +
                 "; remove one");
        if (element.properties.size() == most_names)
            fail("more than " + grouped(most_names) + " properties in an element; export fewer");
        element.properties.push_back(std::move(property));
    }

    PlyType type_named(std::string_view name) const {
        const auto type = ply_type_named(name);
        if (!type)
            fail(in_quotes(name) +
                 " is not a PLY type; these are char, uchar, short, ushort, int, uint, float and double");
        return *type;
    }

    const FileBytes& file_;
    const char* at_;
    char line_end_ = '\n';
    std::string_view line_;
    bool has_format_ = false;
    PlyHeader header_;
};

}

PlyHeader parse_ply_header(const FileBytes& file) {
    return HeaderParser(file).parse();
}

}
