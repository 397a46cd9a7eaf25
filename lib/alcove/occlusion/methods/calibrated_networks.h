/// The trained networks of the calibrated estimator.
#pragma once

#include "alcove/occlusion/methods/calibrated_probes.h"

namespace alcove {

/// Trained on exact rays by fit/train_networks.py; the coefficients are in calibrated_*.f32.
template <class Probes>
const RingNetwork& calibrated_network();
template <>
const RingNetwork& calibrated_network<ThirteenProbes>();
template <>
const RingNetwork& calibrated_network<ThirtyEightProbes>();
template <>
const RingNetwork& calibrated_network<SixtyThreeProbes>();

}
