/// Sheets stop rays however they are aligned with the grid: on its planes, between them, across them.
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/traced.h"
#include "voxelized.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

constexpr float voxel = 1.0f / 64, radius = 0.25f;

/// Rotates by the angle, radians, about two axes.
Vec3d tilted(const Vec3d& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec3d q(p.x, c * p.y - s * p.z, s * p.y + c * p.z);
    return {c * q.x + s * q.z, q.y, c * q.z - s * q.x};
}

/// Two parallel squares. Before tilting, the box around them reaches from z = −below to z = gap, in voxels; its
/// diagonal is 1.
class Pair {
  public:
    /// `below` shifts the pair relative to the grid, whose lowest plane touches the box.
    Pair(double gap, double below, double tilt, bool lower_faces_up, bool upper_faces_up)
        : gap_(gap), tilt_(tilt), up_{lower_faces_up, upper_faces_up}, plates_(mesh(below), radius, voxel) {}

    /// The ao near the middle of a square, on its upper or lower side.
    std::vector<float> ao(bool upper, bool up) const {
        std::vector<Surfel> surfels;
        const Vec3 normal(tilted({0, 0, up ? 1 : -1}, tilt_));
        for (int i = 0; i < 8; ++i)
            surfels.push_back(
                {plates_.frame.to_unit(tilted({0.0113 * (i - 4), 0.0071 * (i - 2), upper ? gap_ * voxel : 0.0}, tilt_)),
                 normal});
        return evaluate_ao(surfels, plates_.field, Traced{.radius = radius, .rays = 1024});
    }

    bool faces_up(bool upper) const { return up_[upper]; }
    bool two_sided() const { return plates_.field.two_sided(); }
    double diagonal() const { return plates_.frame.diagonal; }

  private:
    Mesh mesh(double below) const {
        Mesh mesh;
        const double height = (gap_ + below) * voxel, half = std::sqrt((1.0 - height * height) / 8.0);
        for (const bool upper : {false, true}) {
            const double z = upper ? gap_ * voxel : 0.0;
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const Vec3d& p :
                 {Vec3d(-half, -half, z), Vec3d(half, -half, z), Vec3d(half, half, z), Vec3d(-half, half, z)})
                mesh.positions.push_back(tilted(p, tilt_));
            if (up_[upper])
                mesh.add_face(std::array{first, first + 1, first + 2, first + 3});
            else
                mesh.add_face(std::array{first + 3, first + 2, first + 1, first});
        }
        if (below > 0.0) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const double x : {0.0, 0.01, 0.02})
                mesh.positions.push_back(tilted({x - half, -half, x == 0.0 ? 0.0 : -below * voxel}, tilt_));
            mesh.add_face(std::array{first, first + 1, first + 2});
        }
        return mesh;
    }

    double gap_, tilt_;
    bool up_[2];
    test::Voxelized plates_;
};

/// Between the squares ao = (gap/R)², because they are wider than the radius. Rays from the back of a square start up
/// to two voxels away from it. Rays toward the back of a square end at the far side of its negative layer at the
/// earliest.
void expect_no_leaks(double gap, double below, double tilt) {
    for (const bool lower_up : {true, false})
        for (const bool upper_up : {true, false}) {
            const Pair pair(gap, below, tilt, lower_up, upper_up);
            SCOPED_TRACE(testing::Message()
                         << "gap " << gap << " below " << below << " tilt " << tilt << " up " << lower_up << upper_up);
            ASSERT_TRUE(pair.two_sided());
            const auto open = [&](double voxels) {
                const double share = std::max(voxels, 0.0) * voxel / (radius * pair.diagonal());
                return std::min(share * share, 1.0);
            };
            for (const bool upper : {false, true}) {
                const bool from_front = pair.faces_up(upper) == !upper;
                const bool to_front = pair.faces_up(!upper) == upper;
                // A tenth of a voxel for the starts of rays, and as much for interpolation between tilted planes.
                constexpr double slack = 0.25;
                const double early = slack + (from_front ? 0.0 : 2.0) + (to_front ? 0.0 : 1.9);
                for (const float ao : pair.ao(upper, !upper)) {
                    EXPECT_LE(ao, open(gap + slack * pair.diagonal()) + 0.01);
                    EXPECT_GE(ao, open(gap - early * pair.diagonal()) - 0.01);
                }
                // Behind a tilted face, rays may graze the uneven end of its negative layer.
                if (tilt == 0.0 || pair.faces_up(upper) == upper) {
                    for (const float ao : pair.ao(upper, upper))
                        EXPECT_GE(ao, 0.99f);
                }
            }
        }
}

TEST(SheetPairs, StopRaysAtAnyGap) {
    for (const double gap : {2.3, 3.0, 4.0, 4.4, 5.0, 6.0, 7.5, 8.0, 10.0, 10.5, 12.0})
        expect_no_leaks(gap, 0.0, 0.0);
}

TEST(SheetPairs, StopRaysWhereverInTheGrid) {
    for (const double below : {1e-6, 0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0})
        expect_no_leaks(10.0, below, 0.0);
}

TEST(SheetPairs, StopRaysAtAnyTilt) {
    for (const double tilt : {1e-4, 0.003, 0.02, 0.1, 0.3, 0.5, 0.7853981633974483})
        expect_no_leaks(8.0, 0.0, tilt);
}

/// A single square does not occlude itself on either side, on a plane of the grid or between planes.
TEST(SheetPairs, ALoneSquareIsOpenOnBothSides) {
    for (const double z : {0.0, 0.3, -1.7}) {
        Mesh mesh;
        for (const Vec3d& p : {Vec3d(-1, -1, z), Vec3d(1, -1, z), Vec3d(1, 1, z), Vec3d(-1, 1, z)})
            mesh.positions.push_back(p);
        mesh.add_face(std::array{0u, 1u, 2u, 3u});
        const test::Voxelized plate(mesh, radius, voxel);
        for (const float up : {1.0f, -1.0f}) {
            std::vector<Surfel> surfels;
            for (int i = -9; i <= 9; ++i)
                surfels.push_back({plate.frame.to_unit({0.1 * i, 0.07 * i, z}), {0, 0, up}});
            for (const float ao : evaluate_ao(surfels, plate.field, Traced{.radius = radius, .rays = 256}))
                EXPECT_EQ(ao, 1.0f);
        }
    }
}

}
}
