#include "alcove/occlusion/methods/calibrated_networks.h"

#include <bit>
#include <cstring>
#include <utility>
#include <vector>

namespace alcove {
namespace {

static_assert(std::endian::native == std::endian::little, "the coefficients are stored as little-endian floats");

// CMake writes the bytes of calibrated_*.f32 to the .inc files.
constexpr unsigned char thirteen[] = {
#include "alcove/occlusion/calibrated_13.inc"
};
constexpr unsigned char thirty_eight[] = {
#include "alcove/occlusion/calibrated_38.inc"
};
constexpr unsigned char sixty_three[] = {
#include "alcove/occlusion/calibrated_63.inc"
};

template <class Probes>
RingNetwork network_of(std::span<const unsigned char> bytes, std::size_t first, std::size_t second) {
    std::vector<float> coefficients(bytes.size() / sizeof(float));
    std::memcpy(coefficients.data(), bytes.data(), bytes.size());
    return {{Probes::normal.size(), Probes::azimuths, Probes::rings.size(), first, second}, std::move(coefficients)};
}

}

template <>
const RingNetwork& calibrated_network<ThirteenProbes>() {
    static const RingNetwork network = network_of<ThirteenProbes>(thirteen, 16, 16);
    return network;
}

template <>
const RingNetwork& calibrated_network<ThirtyEightProbes>() {
    static const RingNetwork network = network_of<ThirtyEightProbes>(thirty_eight, 16, 16);
    return network;
}

template <>
const RingNetwork& calibrated_network<SixtyThreeProbes>() {
    static const RingNetwork network = network_of<SixtyThreeProbes>(sixty_three, 24, 16);
    return network;
}

}
