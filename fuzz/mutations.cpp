#include "mutations.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace alcove::fuzz {
namespace {

constexpr std::array<std::string_view, 22> extreme_words{"nan",
                                                         "inf",
                                                         "-inf",
                                                         "1e39",
                                                         "1e308",
                                                         "-1e308",
                                                         "1e-320",
                                                         "-0",
                                                         "0",
                                                         "1",
                                                         "-1",
                                                         "255",
                                                         "-32769",
                                                         "2147483647",
                                                         "2147483648",
                                                         "-2147483649",
                                                         "4294967295",
                                                         "4294967296",
                                                         "9223372036854775808",
                                                         "18446744073709551616",
                                                         "",
                                                         "word"};
/// Little endian: extremes of 32-bit numbers in 4 bytes, of 64-bit numbers in 8.
constexpr std::array<std::string_view, 9> extreme_bytes{{{"\0\0\0\0", 4},
                                                         {"\xff\xff\xff\xff", 4},
                                                         {"\xff\xff\xff\x7f", 4},
                                                         {"\0\0\0\x80", 4},
                                                         {"\0\0\x80\x7f", 4},         // infinity
                                                         {"\0\0\xc0\x7f", 4},         // not a number
                                                         {"\xff\xff\x7f\x7f", 4},     // the largest float
                                                         {"\0\0\0\0\0\0\xf0\x7f", 8}, // infinity in double precision
                                                         {"\xff\xff\xff\xff\xff\xff\xff\x7f", 8}}};

class Mutator {
  public:
    Mutator(std::string& bytes, const std::vector<std::string>& others, Random& random)
        : bytes_(bytes), others_(others), random_(random) {}

    void mutate_once() {
        const std::size_t at = below(bytes_.size() + 1);
        switch (below(9)) {
        case 0:
            if (at < bytes_.size())
                bytes_[at] = static_cast<char>(bytes_[at] ^ (1 << below(8)));
            break;
        case 1:
            if (at < bytes_.size())
                bytes_[at] = static_cast<char>(below(256));
            break;
        case 2:
        case 3:
            replace_word(at);
            break;
        case 4:
            overwrite(at, extreme_bytes[below(extreme_bytes.size())]);
            break;
        case 5:
            bytes_.erase(at, length());
            break;
        case 6:
            bytes_.insert(at, bytes_.substr(at, length()));
            break;
        case 7: {
            const std::string& other = others_[below(others_.size())];
            const std::size_t from = below(other.size() + 1); // drawn before length()
            overwrite(at, std::string_view(other).substr(from, length()));
            break;
        }
        default:
            if (below(4) == 0) // rarely, or little would be left to change
                bytes_.resize(at);
        }
    }

  private:
    std::size_t below(std::size_t bound) { return random_() % bound; }
    /// Length of a random range, usually short.
    std::size_t length() { return 1 + below(std::size_t{1} << below(9)); }

    void overwrite(std::size_t at, std::string_view bytes) { bytes_.replace(at, bytes.size(), bytes); }

    void replace_word(std::size_t at) {
        const auto in_word = [](unsigned char c) {
            return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '+' || c == '_';
        };
        const auto begin = std::find_if(bytes_.begin() + static_cast<std::ptrdiff_t>(at), bytes_.end(), in_word);
        const auto end = std::find_if_not(begin, bytes_.end(), in_word);
        bytes_.replace(begin, end, extreme_words[below(extreme_words.size())]);
    }

    std::string& bytes_;
    const std::vector<std::string>& others_;
    Random& random_;
};

}

std::string mutated(std::string bytes, const std::vector<std::string>& others, Random& random) {
    Mutator mutator(bytes, others, random);
    for (std::size_t changes = 1 + random() % 6; changes > 0; --changes)
        mutator.mutate_once();
    return bytes;
}

}
