/// Work that a time limit is far too short for is refused before it is begun, with what fits.
#include "program.h"

namespace alcove::test {
namespace {

class TimeLimit : public ProgramTest {
  protected:
    /// The number after a word of the refusal.
    int remedy(const std::vector<std::string>& arguments, const std::string& word) const {
        expect_refusal(arguments, bad_input, {"takes about", "--time-limit", word, "allow"});
        const std::string err = run(arguments).err;
        const std::size_t at = err.find(word);
        return at == std::string::npos ? 0 : std::stoi(err.substr(at + word.size()));
    }
};

TEST_F(TimeLimit, RefusesABakeOfTooManyRays) {
    for (const char* method : {"traced", "exact"}) {
        const int rays = remedy({"bake", real_mesh("armadillo.off"), "-o", "a.ply", "--method", method,
                                 "--rays", "50000", "--time-limit", "9"},
                                "use --rays ");
        EXPECT_GT(rays, 100);
        EXPECT_LT(rays, 25000);
    }
    EXPECT_TRUE(files().empty());
}

TEST_F(TimeLimit, RefusesAPictureOfTooManyPixels) {
    const std::vector<std::string> arguments{
        "render", real_mesh("armadillo.off"), "-o", "a.png", "--rays", "64", "--time-limit", "9", "--size"};
    const auto of_size = [&](const char* size) {
        std::vector<std::string> all = arguments;
        all.emplace_back(size);
        return all;
    };
    const int width = remedy(of_size("3200x2400"), "use --size ");
    EXPECT_GT(width, 320);
    EXPECT_LT(width, 2300);
    EXPECT_TRUE(files().empty());
}

TEST_F(TimeLimit, LetsWorkPassThatFits) {
    EXPECT_EQ(run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--time-limit", "60"}).code, done);
    EXPECT_EQ(
        run({"bake", real_mesh("elephant.off"), "-o", "b.ply", "--error", "0.05", "--time-limit", "60"}).code,
        done);
    EXPECT_EQ(
        run({"render", real_mesh("elephant.off"), "-o", "a.png", "--size", "64x48", "--time-limit", "60"})
            .code,
        done);
}

}
}
