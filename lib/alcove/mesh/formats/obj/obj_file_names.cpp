#include "alcove/mesh/formats/obj/obj_file_names.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/text_scanner.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>

namespace alcove {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 16;   // tokens: a name with blanks consists of several
constexpr std::size_t most_lookups = 4096; // of files; limits the work on a malicious text

bool is_absolute(std::string_view name) {
    const bool has_drive = name.size() > 2 && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
                           name[1] == ':' && (name[2] == '\\' || name[2] == '/');
    return has_drive || name.starts_with('/') || name.starts_with('\\');
}

std::string_view without_quotes(std::string_view name) {
    return name.size() > 2 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2) : name;
}

class NameMover {
  public:
    NameMover(const ObjDocument& document, const FileBytes& text, const fs::path& folder)
        : document_(document), text_(text), from_(document.folder.empty() ? "." : document.folder),
          to_(folder.empty() ? "." : folder), line_(text, text.begin(), obj_syntax) {}

    MovedNames moved() {
        std::error_code ignored;
        if (fs::equivalent(from_, to_, ignored))
            return {};
        for (const std::size_t offset : document_.file_lines)
            move_line(text_.begin() + offset);
        if (!moved_.replacements.empty())
            moved_.warnings.push_back(counted(moved_.replacements.size(), "path was", "paths were") +
                                      " rewritten relative to the output folder: " + first_change_);
        if (lost_ > 0)
            moved_.warnings.push_back(counted(lost_, "path was", "paths were") +
                                      " kept, but no such file was found relative to the input folder: " + first_lost_);
        return std::move(moved_);
    }

  private:
    /// Rewrites the names on a line. A name is the longest run of tokens that together lead to a file.
    void move_line(const char* keyword) {
        line_.move_to(keyword);
        line_.word("a keyword");
        std::vector<std::string_view> tokens;
        for (; !line_.at_line_end(); line_.word("a name"))
            tokens.push_back(line_.peek());
        for (std::size_t first = 0; first < tokens.size();) {
            std::size_t count = std::min(longest_name, tokens.size() - first);
            while (count > 0 && !move_name({tokens[first].data(), tokens[first + count - 1].end()}))
                --count;
            if (count == 0 && lost_++ == 0)
                first_lost_ = in_quotes(tokens[first]) + " in line " + grouped(text_.line_at(tokens[first].data()));
            first += std::max<std::size_t>(count, 1);
        }
    }

    /// Rewrites a name so that it leads to the same file from the output folder. \return false if the name leads to no
    /// file or cannot be rewritten.
    bool move_name(std::string_view quoted) {
        const std::string_view name = without_quotes(quoted);
        if (is_absolute(name))
            return true;
        const std::optional<fs::path> file = file_named(name);
        if (!file)
            return false;
        std::error_code ignored;
        if (fs::equivalent(from_ / *file, to_ / fs::path(name), ignored))
            return true;
        const std::string seen = name_seen_from_output(from_ / *file);
        // A line break in the name would end the line, and " #" would begin a comment.
        if (seen.empty() || seen.find_first_of("\r\n") != std::string::npos || seen.find(" #") != std::string::npos)
            return false;
        if (moved_.replacements.empty())
            first_change_ = in_quotes(name) + " is now " + in_quotes(seen);
        const auto begin = static_cast<std::size_t>(name.data() - text_.begin());
        moved_.replacements.push_back({begin, begin + name.size(), seen});
        return true;
    }

    /// The name as a path, if it points to a file as seen from the input folder.
    std::optional<fs::path> file_named(std::string_view name) {
        std::string with_slashes(name);
        std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
        for (const fs::path& path : {fs::path(name), fs::path(with_slashes)}) {
            std::error_code ignored;
            if (lookups_++ < most_lookups && fs::is_regular_file(from_ / path, ignored))
                return path;
        }
        return {};
    }

    /// The path of a file relative to the output folder; empty if there is none. Links are followed only in folders: a
    /// library that is itself a link names its textures relative to the link.
    std::string name_seen_from_output(const fs::path& file) const {
        std::error_code error;
        const fs::path folder = fs::canonical(file.parent_path(), error);
        const fs::path to = error ? fs::path() : fs::canonical(to_, error);
        return error ? std::string() : (folder / file.filename()).lexically_relative(to).generic_string();
    }

    const ObjDocument& document_;
    const FileBytes& text_;
    const fs::path from_, to_;
    TextScanner line_;
    MovedNames moved_;
    std::size_t lookups_ = 0, lost_ = 0;
    std::string first_change_, first_lost_;
};

}

MovedNames moved_names(const ObjDocument& document, const FileBytes& text, const std::filesystem::path& folder) {
    return NameMover(document, text, folder).moved();
}

}
