/// Scans numbers and words from a text in memory. Fast and strict; errors name the line.
#pragma once

#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <fast_float/fast_float.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace alcove {

struct TextSyntax {
    char comment = '\0';       ///< begins a comment, to the end of the line, wherever a token may start
    bool continuation = false; ///< a backslash at the end of a line joins the next one to it
    /// Whether a comment may also begin directly after the last digit of a number, as some programs write it. It cannot
    /// begin after a point: "1.#IND".
    bool comment_after_digit = false;
};
inline constexpr TextSyntax off_syntax{'#', false, true};
inline constexpr TextSyntax obj_syntax{'#', true};

/// The value of a token that old run-time libraries print for infinity or NaN: "1.#INF00", "-1.#IND", "1.#QNAN0e+000",
/// or, if rounded like digits, "1.#J" and "1.$"; also "∞". std::nullopt for other tokens.
std::optional<double> non_finite_number(std::string_view token);

/// Reads a text token by token. Tokens are separated by blanks and line ends (LF, CRLF, CR). Skips a byte-order mark
/// before the text and padding after it.
class TextScanner {
  public:
    TextScanner(const FileBytes& file, const char* begin, TextSyntax syntax = {})
        : file_(file), at_(begin == file.begin() ? without_byte_order_mark(file.view()).data() : begin),
          end_(file.begin() + without_padding(file.view()).size()), syntax_(syntax) {}

    const char* at() const { return at_; }
    void move_to(const char* place) { at_ = place; }
    bool at_token_end() const { return is_token_end(at_); }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
    /// The number of NUL and Ctrl-Z bytes after the text, including blanks between them.
    std::size_t padding() const { return static_cast<std::size_t>(file_.end() - end_); }

    /// Skips blanks. \return whether a line end, a comment or the end of the file follows.
    bool at_line_end() {
        while (at_ < end_ && (is_blank(*at_) || is_continuation(at_)))
            at_ += is_blank(*at_) ? 1 : continuation_length(at_);
        return at_ == end_ || is_line_end(*at_) || is_comment(*at_);
    }
    /// Moves past the end of this line. \throw Cancelled
    void next_line() {
        check_cancelled();
        bool in_comment = false, token_begins = true;
        for (; at_ < end_ && !is_line_end(*at_); ++at_) {
            in_comment |= token_begins && is_comment(*at_);
            token_begins = is_blank(*at_);
            if (!in_comment && is_continuation(at_)) {
                at_ += continuation_length(at_) - 1;
                token_begins = true;
            }
        }
        const bool carriage_return = at_ < end_ && *at_ == '\r';
        if (at_ < end_)
            ++at_;
        if (carriage_return && at_ < end_ && *at_ == '\n')
            ++at_;
    }
    /// Skips blanks, line ends and comments. \return whether the end of the file follows.
    bool at_end() {
        while (at_line_end()) {
            if (at_ == end_)
                return true;
            next_line();
        }
        return false;
    }
    /// The token at this position, without moving; empty at a line end.
    std::string_view peek() {
        if (at_line_end())
            return {};
        const char* last = at_;
        while (!is_token_end(last))
            ++last;
        return {at_, static_cast<std::size_t>(last - at_)};
    }
    /// The number of tokens to the end of the line, at most `limit`, without moving.
    std::size_t tokens_on_line(std::size_t limit) {
        TextScanner ahead(*this);
        std::size_t count = 0;
        for (; count < limit && !ahead.at_line_end(); ++count)
            ahead.at_ += ahead.peek().size();
        return count;
    }

    /// The next token, on this line or a later one. \throw InputError at the end of the file.
    std::string_view word(const char* expected) {
        if (at_end())
            fail_early(expected);
        const std::string_view token = peek();
        at_ += token.size();
        return token;
    }
    /// The next token as a number, which need not be finite. \throw InputError if it is not a number.
    template <class Real = double>
    Real number(const char* expected) {
        if (at_end())
            fail_early(expected);
        Real value{};
        const char* const last = end_of_number(value);
        if (last == nullptr)
            fail_token("a number", expected);
        at_ = last;
        return value;
    }
    /// The next token of this line as a number; NaN if it is not a number. \pre the line has another token
    double number_or_nan() {
        double value = 0.0;
        const char* const last = end_of_number(value);
        at_ = last != nullptr ? last : at_ + peek().size();
        return last != nullptr ? value : std::numeric_limits<double>::quiet_NaN();
    }
    /// The next token as an integer. \throw InputError if it is not an integer or has more than 18 digits.
    std::int64_t integer(const char* expected) {
        if (at_end())
            fail_early(expected);
        const char* digit = at_;
        const bool negative = *digit == '-';
        if (negative || *digit == '+')
            ++digit;
        const char* const first = digit;
        std::int64_t value = 0;
        for (; digit < end_ && *digit >= '0' && *digit <= '9'; ++digit)
            if (digit - first < longest_integer)
                value = value * 10 + (*digit - '0');
        if (digit == first || digit - first > longest_integer ||
            !(is_token_end(digit) || is_comment_after_digit(digit)))
            fail_token("a whole number", expected);
        at_ = digit;
        return negative ? -value : value;
    }

    [[noreturn]] void fail(std::string_view message) const { file_.fail_at_line(at_, message); }
    [[noreturn]] void fail_early(const char* expected) const {
        file_.fail_at_line(end_,
                           std::string("the file ends early: ") + expected + " is missing; copy or export it again");
    }

  private:
    static constexpr std::ptrdiff_t longest_integer = 18;

    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
    bool is_comment(char c) const { return syntax_.comment != '\0' && c == syntax_.comment; }
    bool is_continuation(const char* at) const {
        return *at == '\\' && syntax_.continuation && at + 1 < end_ && is_line_end(at[1]);
    }
    static std::ptrdiff_t continuation_length(const char* at) { return at[1] == '\r' && at[2] == '\n' ? 3 : 2; }
    bool is_token_end(const char* at) const {
        return at == end_ || is_blank(*at) || is_line_end(*at) || is_continuation(at);
    }
    bool is_comment_after_digit(const char* at) const {
        return syntax_.comment_after_digit && at < end_ && is_comment(*at) && at[-1] >= '0' && at[-1] <= '9';
    }
    /// Stores the value of the token at this position and returns the end of the token; null if it is not a number.
    template <class Real>
    const char* end_of_number(Real& value) {
        const char* const first = at_ + (*at_ == '+' && at_ + 1 < end_ && at_[1] != '-' ? 1 : 0);
        const auto [last, error] = fast_float::from_chars(first, end_, value);
        if (error != std::errc::invalid_argument && (is_token_end(last) || is_comment_after_digit(last)))
            return last;
        const std::string_view token = peek();
        const std::optional<double> non_finite = non_finite_number(token);
        value = static_cast<Real>(non_finite.value_or(0.0));
        return non_finite ? token.data() + token.size() : nullptr;
    }
    [[noreturn]] void fail_token(const char* kind, const char* expected) {
        const std::string_view token = peek();
        fail(in_quotes(token) + " is not " + kind + "; " + expected + " is expected here" +
             (token.find(',') != std::string_view::npos ? ", with a point before decimals" : ""));
    }

    const FileBytes& file_;
    const char* at_;
    const char* end_;
    TextSyntax syntax_;
};

}
