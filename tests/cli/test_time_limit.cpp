/// Work that would clearly exceed a time limit is refused, and the message names settings that fit. The limits leave
/// room for machines a few times slower or faster, and the tests use one thread on any machine.
#include "program.h"

namespace alcove::test {
namespace {

class TimeLimit : public ProgramTest {
  protected:
#ifdef __SANITIZE_ADDRESS__
    static constexpr int slowness = 10; // factor under sanitizers
#else
    static constexpr int slowness = 1;
#endif
    Outcome run_limited(std::vector<std::string> arguments, int seconds) const {
        for (const std::string& word : {std::string("--threads"), std::string("1"), std::string("--time-limit"),
                                        std::to_string(slowness * seconds)})
            arguments.push_back(word);
        return run(std::move(arguments));
    }
    /// The text after a word of the error message, up to the next comma.
    std::string remedy(const std::vector<std::string>& arguments, int seconds, const std::string& word) const {
        const Outcome outcome = run_limited(arguments, seconds);
        EXPECT_EQ(outcome.code, failure);
        EXPECT_NE(outcome.err.find("takes about"), std::string::npos) << outcome.err;
        EXPECT_TRUE(files().empty());
        const std::size_t at = outcome.err.find(word);
        if (at == std::string::npos) {
            ADD_FAILURE() << "'" << word << "' is not in: " << outcome.err;
            return "0";
        }
        const std::size_t begin = at + word.size();
        return outcome.err.substr(begin, outcome.err.find(',', begin) - begin);
    }
};

TEST_F(TimeLimit, NamesRaysOfABakeThatFit) {
    for (const char* method : {"traced", "exact"}) {
        const std::vector<std::string> bake{
            "bake", real_mesh("armadillo.off"), "-o", "a.ply", "--no-pilot", "--method", method, "--rays"};
        std::vector<std::string> many = bake, fewer = bake;
        many.emplace_back("30000");
        fewer.push_back(remedy(many, 3, "use --rays "));
        EXPECT_GT(std::stoi(fewer.back()), 30);
        EXPECT_EQ(run_limited(fewer, 6).code, done) << fewer.back();
        std::filesystem::remove(folder_ / "work/a.ply");
    }
}

TEST_F(TimeLimit, RefusesPartsToo) {
    remedy({"bake", real_mesh("armadillo.off"), "-o", "a.ply", "--self", "--method", "traced", "--rays", "30000"}, 3,
           "use --rays ");
}

TEST_F(TimeLimit, NamesAPictureThatFits) {
    const std::vector<std::string> picture{
        "render", real_mesh("armadillo.off"), "-o", "a.png", "--method", "traced", "--rays", "16", "--size"};
    std::vector<std::string> large = picture, smaller = picture;
    large.emplace_back("1600x1200");
    smaller.push_back(remedy(large, 3, "use --size "));
    EXPECT_GT(std::stoi(smaller.back()), 160);
    EXPECT_EQ(run_limited(smaller, 6).code, done) << smaller.back();
}

TEST_F(TimeLimit, NamesAnErrorThatFits) {
    if (slowness > 1)
        GTEST_SKIP() << "the planner's cost table does not apply under sanitizers";
    const std::string error =
        remedy({"bake", real_mesh("refined_elephant.off"), "-o", "a.ply", "--error", "0.0015"}, 2, "use --error ");
    EXPECT_GT(std::stod(error), 0.0015);
}

TEST_F(TimeLimit, LetsWorkPassThatFits) {
    EXPECT_EQ(run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--time-limit", "60"}).code, done);
    EXPECT_EQ(run({"bake", real_mesh("elephant.off"), "-o", "b.ply", "--error", "0.05", "--time-limit", "60"}).code,
              done);
    EXPECT_EQ(run({"render", real_mesh("elephant.off"), "-o", "a.png", "--size", "64x48", "--time-limit", "60"}).code,
              done);
}

}
}
