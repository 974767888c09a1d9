// How rare a number is by chance, in nats and as a normal deviate.
#pragma once

namespace gyrolog {

// -ln of the chance that the largest of `tries` chi-square numbers is this large.
double surprise_of_largest(double value, double degrees, double tries);

// The normal deviate that is exceeded as rarely.
double deviate_of(double surprise_nats);

}  // namespace gyrolog
