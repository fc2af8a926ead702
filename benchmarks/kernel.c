/* The practical limit: a map of growth rates with everything hoisted that can be.
 *
 * Per position  30 numbers: D(xi) = sum of tensors in powers of i|xi|, for any direction
 * Per direction 11 numbers: half the trace (t2, t0) + i (s1, sm) and the discriminant Q = ((D11 - D22)/2)^2 + D12 D21,
 *               each a polynomial in |xi|^2 and 1/|xi|^2
 * Per sample    Re sqrt(Q) by two square roots and one division, free of cancellation; the compiler vectorises it
 */
#include <math.h>
#include <stdlib.h>

typedef struct { double two, one, zero, minus; } entry; /* coefficients of w, i k, 1, i/k, with w = k^2 */
typedef struct { double t2, t0, s1, sm, q4, q2, q0, qm, r3, r1, rm; } direction;

static entry at(const double *T, int i, int j, double c, double s)
{
    const double *second = T + 2 * i + j, *first = T + 12 + 2 * i + j;
    const double *zeroth = T + 20 + 2 * i + j, *b1 = T + 24 + i, *b0 = T + 28 + i;
    double chi = j ? s : c;
    return (entry){ c * c * second[0] + c * s * second[4] + s * s * second[8], c * first[0] + s * first[4],
                    zeroth[0] + (c * b1[0] + s * b1[2]) * chi, b0[0] * chi };
}

static direction towards(const double *T, double cosine, double sine)
{
    entry a = at(T, 0, 0, cosine, sine), b = at(T, 0, 1, cosine, sine);
    entry c = at(T, 1, 0, cosine, sine), d = at(T, 1, 1, cosine, sine);
    entry h = { (a.two - d.two) / 2, (a.one - d.one) / 2, (a.zero - d.zero) / 2, (a.minus - d.minus) / 2 };
    direction x;
    x.t2 = (a.two + d.two) / 2, x.t0 = (a.zero + d.zero) / 2, x.s1 = (a.one + d.one) / 2, x.sm = (a.minus + d.minus) / 2;
    x.q4 = h.two * h.two + b.two * c.two;
    x.q2 = 2 * h.two * h.zero + b.two * c.zero + b.zero * c.two - h.one * h.one - b.one * c.one;
    x.q0 = h.zero * h.zero + b.zero * c.zero - 2 * h.one * h.minus - b.one * c.minus - b.minus * c.one;
    x.qm = -(h.minus * h.minus + b.minus * c.minus);
    x.r3 = 2 * h.two * h.one + b.two * c.one + b.one * c.two;
    x.r1 = 2 * h.two * h.minus + b.two * c.minus + b.minus * c.two + 2 * h.zero * h.one + b.zero * c.one + b.one * c.zero;
    x.rm = 2 * h.zero * h.minus + b.zero * c.minus + b.minus * c.zero;
    return x;
}

/* With e = (|Q| + |Re Q|)/2 the parts of sqrt(Q) are sqrt(e) and |Im Q|/2/sqrt(e), the real one first where Re Q >= 0. */
static void growths(direction x, long waves, const double *restrict wavenumber, const double *restrict inverse,
                    double *restrict growth)
{
    for (long n = 0; n < waves; n++) {
        double k = wavenumber[n], w = k * k, iw = inverse[n];
        double re = (x.q4 * w + x.q2) * w + (x.q0 + x.qm * iw), im = k * (x.r3 * w + (x.r1 + x.rm * iw));
        double e = (sqrt(re * re + im * im) + fabs(re)) / 2 + 1e-300;
        growth[n] = x.t2 * w + x.t0 + sqrt(re >= 0 ? e : im * im / 4 / e);
    }
}

static void eigenvalues(direction x, long waves, const double *restrict wavenumber, const double *restrict inverse,
                        double *restrict growth, double *restrict frequency)
{
    for (long n = 0; n < waves; n++) {
        double k = wavenumber[n], w = k * k, iw = inverse[n];
        double re = (x.q4 * w + x.q2) * w + (x.q0 + x.qm * iw), im = k * (x.r3 * w + (x.r1 + x.rm * iw));
        double large = sqrt((sqrt(re * re + im * im) + fabs(re)) / 2 + 1e-300), small = fabs(im) / 2 / large;
        growth[n] = x.t2 * w + x.t0 + (re >= 0 ? large : small);
        frequency[n] = k * (x.s1 + x.sm * iw) + copysign(re >= 0 ? small : large, im);
    }
}

/* tensors (positions, 30); growth and, unless it is NULL, frequency (positions, directions, waves); 0 if out of memory */
int map(long positions, long directions, long waves, const double *tensors, const double *cosine, const double *sine,
        const double *wavenumber, double *growth, double *frequency)
{
    double *inverse = malloc((waves ? waves : 1) * sizeof(double));
    if (!inverse) return 0;
    for (long n = 0; n < waves; n++) inverse[n] = 1 / (wavenumber[n] * wavenumber[n]);
    for (long p = 0; p < positions; p++)
        for (long m = 0; m < directions; m++) {
            const direction x = towards(tensors + 30 * p, cosine[m], sine[m]);
            const long start = (p * directions + m) * waves;
            if (frequency) eigenvalues(x, waves, wavenumber, inverse, growth + start, frequency + start);
            else growths(x, waves, wavenumber, inverse, growth + start);
        }
    free(inverse);
    return 1;
}
