// Quantiles and tails of the distributions that statistics are judged by.
//
// Chances are plain numbers, not percent. A quantile is the point below which the variable lies with chance
// `p`, an upper quantile the one above which it lies with chance `tail`: exact where 1 - tail is not, for the
// smallest tails. What is no chance (outside 0 to 1) or no parameter (not above 0, not finite) is a
// std::domain_error; an infinite quantile is a std::overflow_error.
#pragma once

namespace gyrolog {

// Of the standard normal distribution.
double normal_quantile(double p);
double normal_upper_quantile(double tail);

// `degrees`: of freedom, need not be whole.
double chi_squared_quantile(double degrees, double p);
double chi_squared_upper_quantile(double degrees, double tail);

double students_t_upper_quantile(double degrees, double tail);
// The chance that Student's t exceeds x.
double students_t_upper_tail(double degrees, double x);

// The mean is shape * scale.
double gamma_quantile(double shape, double scale, double p);
double gamma_upper_quantile(double shape, double scale, double tail);
// The chance that a gamma variable of scale 1 exceeds x >= 0: Q(shape, x) (DLMF 8.2.4). 0 where it is below
// the smallest double.
double gamma_upper_tail(double shape, double x);

}  // namespace gyrolog
