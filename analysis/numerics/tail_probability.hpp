// Tail probabilities as surprises, in nats, and as normal deviates.
#pragma once

namespace gyrolog {

// The function returns -ln P, in nats, where P is the chance that the largest of `tries` independent
// chi-square numbers with `degrees` of freedom reaches `value`: P = 1 - (1 - Q(degrees / 2, value /
// 2))^tries, with Q of DLMF 8.2.4. `tries` need not be whole.
double surprise_of_largest(double value, double degrees, double tries);

// The function returns the standard normal deviate that chance exceeds with probability exp(-surprise_nats),
// kept within 1e-280 and 0.99.
double deviate_of(double surprise_nats);

}  // namespace gyrolog
