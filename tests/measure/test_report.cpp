#include "alcove/measure/report.h"

#include <gtest/gtest.h>

#include <regex>

namespace alcove {
namespace {

Measurement made_up(const std::string& mesh, const std::string& method, int samples, double seconds, double rmse,
                    float voxel = 0.0f, float radius = 0.1f) {
    Measurement m;
    m.mesh = mesh, m.method = method, m.samples = samples;
    m.occlusion_seconds = seconds;
    m.error.rmse = rmse;
    m.voxel = m.asked_voxel = voxel, m.radius = radius;
    return m;
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++found;
    return found;
}

TEST(Report, NeedsNoNetworkAndNoOtherFile) {
    std::vector<Measurement> measurements{made_up("a.ply", "exact", 64, 1.0, 0.01)};
    measurements.front().picture = "data:image/png;base64,AAAA";
    std::string page = report(measurements);
    EXPECT_EQ(count(page, "src="), count(page, "src=\"data:"));
    EXPECT_EQ(count(page, "src="), 1u);
    page = std::regex_replace(page, std::regex("xmlns=\"http://www.w3.org/2000/svg\""), "");
    for (const char* reference : {"http", "href", "url(", "@import", "//"})
        EXPECT_EQ(count(page, reference), 0u) << reference;
}

TEST(Report, ListsTheBestFirstAndMarksTheFront) {
    const std::string page =
        report(std::vector{made_up("a.ply", "classic", 5, 1.0, 0.2), made_up("a.ply", "decay", 5, 2.0, 0.3),
                           made_up("a.ply", "exact", 64, 3.0, 0.01)});
    const std::size_t exact = page.find("<td>exact:64</td>"), classic = page.find("<td>classic:5</td>"),
                      decay = page.find("<td>decay:5</td>");
    ASSERT_NE(decay, std::string::npos);
    EXPECT_LT(exact, classic);
    EXPECT_LT(classic, decay);
    EXPECT_EQ(count(page, "<tr class=\"front\"><td>exact:64"), 1u);
    EXPECT_EQ(count(page, "<tr class=\"front\"><td>classic:5"), 1u);
    EXPECT_EQ(count(page, "<tr class=\"front\"><td>decay:5"), 0u);
    EXPECT_EQ(count(page, "<svg"), 2u); // total time, and occlusion only
}

TEST(Report, DrawsErrorAgainstVoxelRadiusAndAllMeshes) {
    std::vector<Measurement> measurements;
    for (const char* mesh : {"a.ply", "b.ply"})
        for (const float voxel : {0.01f, 0.02f})
            for (const float radius : {0.1f, 0.2f})
                measurements.push_back(made_up(mesh, "classic", 5, 1.0, voxel, voxel, radius));
    const std::string page = report(measurements);
    for (const char* heading : {"All 2 meshes", "Error and time at a radius of 10 %",
                                "Error and voxel at a radius of 20 %", "Error and radius, voxel 1 %"})
        EXPECT_NE(page.find(heading), std::string::npos) << heading;
    EXPECT_EQ(report(std::vector{measurements.front()}).find("Error and voxel"), std::string::npos);
}

TEST(Report, KeepsNamesFromBeingMarkup) {
    const std::string page = report(std::vector{made_up("<b>&\".ply", "classic", 5, 0.0, 0.0)});
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;&amp;&quot;.ply"), std::string::npos);
    EXPECT_EQ(page.find("nan"), std::string::npos) << "no error and no time on logarithmic axes";
    EXPECT_EQ(page.find("inf"), std::string::npos);
}

}
}
