#include "length.h"

#include "common.h"

#include "alcove/base/errors.h"

namespace alcove::cli {

Length parse_length(const std::string& text, const std::string& option) {
    try {
        return alcove::parse_length(text);
    } catch (const InputError& error) {
        throw UsageError(option + " " + error.what());
    }
}

float to_unit(const Length& length, double diagonal, float voxel) {
    try {
        return length.to_unit(diagonal, voxel);
    } catch (const InputError& error) {
        throw UsageError(error.what());
    }
}

}
