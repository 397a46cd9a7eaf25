#include "alcove/occlusion/catalog.h"

#include "alcove/base/types.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace alcove {
namespace {

TEST(MethodChoice, SetsSamplesOrRaysWhicheverTheMethodHas) {
    const MethodChoice exact = choose(find_method("exact"), 16);
    EXPECT_EQ(exact.label(), "exact:16");
    EXPECT_EQ(exact.rays(), 16);
    EXPECT_EQ(exact.settings(0.2f).radius, 0.2f);
    EXPECT_EQ(exact.settings(0.2f).parameters, (decltype(Settings::parameters){{"rays", 16.0}}));
    const MethodChoice classic = choose(find_method("classic"));
    EXPECT_EQ(classic.label(), "classic:5");
    EXPECT_EQ(classic.rays(), 0);
    EXPECT_EQ(classic.settings(0.2f).parameters, (decltype(Settings::parameters){{"samples", 5.0}}));
    EXPECT_EQ(choose(find_method("multiscale")).label(), "multiscale");
    EXPECT_TRUE(choose(find_method("multiscale")).settings(0.2f).parameters.empty());
}

TEST(MethodChoice, RefusesNumbersThatTheMethodDoesNotTake) {
    EXPECT_THROW(choose(find_method("multiscale"), 4), InputError);
    EXPECT_THROW(choose(find_method("exact"), 0), InputError);
    EXPECT_THROW(choose(find_method("calibrated"), 64), InputError);
}

TEST(MethodChoice, StandardOnesCoverTheCatalogOnceEach) {
    std::set<std::string> labels, methods;
    const std::vector<MethodChoice> choices = standard_choices();
    for (const MethodChoice& choice : choices) {
        labels.insert(choice.label());
        methods.emplace(choice.method->name);
    }
    EXPECT_EQ(labels.size(), choices.size());
    for (const Method& method : catalog())
        EXPECT_EQ(methods.contains(std::string(method.name)), method.gives.has(Channel::ao)) << method.name;
    for (const char* label :
         {"guided:1", "guided:3", "guided:8", "exact:4", "exact:16", "exact:64", "traced:16", "traced:64"})
        EXPECT_TRUE(labels.contains(label)) << label;
}

}
}
