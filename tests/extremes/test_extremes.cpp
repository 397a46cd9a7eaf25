/// Checks every row of the table of extreme cases.
#include "extreme.h"

#include <gtest/gtest.h>

#include <cctype>

namespace alcove::extremes {
namespace {

class Extremes : public testing::TestWithParam<Extreme> {};

TEST_P(Extremes, Hold) {
    const Result result = GetParam().run();
    std::printf("%s, %s:", GetParam().group.c_str(), GetParam().name.c_str());
    for (const Figure& figure : result.figures)
        std::printf(" %s %.2g", figure.of.c_str(), figure.value);
    std::printf("; %s\n", result.note.c_str());
    EXPECT_FALSE(result.figures.empty());
    for (const Figure& figure : result.figures)
        EXPECT_TRUE(figure.holds()) << figure.of << ": " << figure.value << " for " << figure.bound << "\n"
                                    << GetParam().must;
}

std::string name_of(const testing::TestParamInfo<Extreme>& info) {
    std::string name = info.param.group + "_" + std::to_string(info.index) + "_" + info.param.name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Table, Extremes, testing::ValuesIn(all_extremes()), name_of);

}
}
