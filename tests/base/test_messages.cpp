#include "alcove/base/detail/messages.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

TEST(Messages, ShowNoControlCharacters) {
    EXPECT_EQ(in_one_line("\x1b]0;pwn\x07.ply\n\t\x7f"), "?]0;pwn?.ply???");
    EXPECT_EQ(in_one_line("\xc2\x9b"
                          "31m"),
              "??31m")
        << "U+009B begins a terminal sequence like ESC [";
    EXPECT_EQ(in_one_line("\x9b"
                          "31m"),
              "?31m")
        << "the same in Latin-1";
}

TEST(Messages, KeepUtf8AndNothingElse) {
    for (const char* text : {"H\xc3\xb6he", "\xe9\x9d\xa2", "\xf0\x9f\x90\x87", "\xc2\xa0", ""})
        EXPECT_EQ(in_one_line(text), text);
    EXPECT_EQ(in_one_line("\xc3"), "?");
    EXPECT_EQ(in_one_line("\xc0\xaf"), "??") << "too long for its code";
    EXPECT_EQ(in_one_line("\xe0\x80\x80"), "???");
    EXPECT_EQ(in_one_line("\xed\xa0\x80"), "???") << "a surrogate";
    EXPECT_EQ(in_one_line("\xf5\x80\x80\x80"), "????");
}

TEST(Messages, QuotesHoldFortyCharacters) {
    EXPECT_EQ(in_quotes("a b"), "'a b'");
    EXPECT_EQ(in_quotes("\x1b[2J"), "'?[2J'");
    EXPECT_EQ(in_quotes(std::string(40, 'x')), "'" + std::string(40, 'x') + "'");
    EXPECT_EQ(in_quotes(std::string(41, 'x')), "'" + std::string(40, 'x') + "...'");
    EXPECT_EQ(in_quotes(std::string(39, 'x') + "\xc3\xb6\xc3\xb6"), "'" + std::string(39, 'x') + "\xc3\xb6...'");
}

}
}
