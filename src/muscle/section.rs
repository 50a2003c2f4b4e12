//! The wall's cross-section: its energy as an integral over the reference wall.

use super::material::Material;
use crate::scalar::Scalar;

/// Points per panel of the Gauss-Legendre rule.
const POINTS: usize = 16;
/// A panel spans at most this much of `ln(B^2)`: bores down to 0.37 of the outer radius need one panel.
const PANEL_SPAN: f64 = 2.0;

/// Energy of the section over `pi R_c^2 L0`, and its derivatives; Pa.
///
/// `l` is the axial stretch, `y = a^2/R_c^2` the squared outer radius over the coil's bore.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionEnergy<D> {
    pub u: D,
    pub u_l: D,
    pub u_y: D,
    pub u_ll: D,
    pub u_ly: D,
    pub u_yy: D,
}

/// Quadrature over the reference wall in `sigma = B^2/R_c^2`, from the bore to 1.
///
/// The hoop stretch is `lambda_theta^2 = (y - (1 - sigma)/lambda)/sigma`: its pole at `sigma = 0` leaves for
/// minus infinity in `ln sigma`, which is why the points are Gauss-Legendre's in that variable.
#[derive(Clone, Debug)]
pub(super) struct Section {
    /// `(sigma, weight)`; the weights sum to `1 - sigma_bore`.
    points: Vec<(f64, f64)>,
    sigma_bore: f64,
}

impl Section {
    pub fn new(sigma_bore: f64) -> Self {
        let panels = (-sigma_bore.ln() / PANEL_SPAN).ceil().max(1.0);
        Self::with_panels(sigma_bore, panels as usize)
    }

    pub fn with_panels(sigma_bore: f64, panels: usize) -> Self {
        let half = -0.5 * sigma_bore.ln() / panels as f64;
        let rule = gauss_legendre();
        let points = (0..panels)
            .flat_map(|panel| {
                let centre = sigma_bore.ln() + half * (2 * panel + 1) as f64;
                rule.map(|(x, weight)| {
                    let sigma = (centre + half * x).exp();
                    (sigma, weight * half * sigma)
                })
            })
            .collect();
        Self { points, sigma_bore }
    }

    pub fn sigma_bore(&self) -> f64 {
        self.sigma_bore
    }

    /// `integral of f(sigma) d sigma` over the wall, component by component.
    pub fn integrate<const N: usize>(&self, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let mut sum = [0.0; N];
        for &(sigma, weight) in &self.points {
            for (total, value) in sum.iter_mut().zip(f(sigma)) {
                *total += weight * value;
            }
        }
        sum
    }

    /// The section's energy at axial stretch `l` and squared outer radius `y`.
    pub fn energy<D: Scalar>(&self, material: &Material<D>, l: D, y: D) -> SectionEnergy<D> {
        let zero = D::constant(0.0);
        let mut sum = SectionEnergy { u: zero, u_l: zero, u_y: zero, u_ll: zero, u_ly: zero, u_yy: zero };
        let shrink = l.recip();
        for &(sigma, weight) in &self.points {
            sum.add(weight, ring_energy(material, l, shrink, y, sigma));
        }
        sum
    }
}

impl<D: Scalar> SectionEnergy<D> {
    fn add(&mut self, weight: f64, ring: SectionEnergy<D>) {
        self.u += ring.u * weight;
        self.u_l += ring.u_l * weight;
        self.u_y += ring.u_y * weight;
        self.u_ll += ring.u_ll * weight;
        self.u_ly += ring.u_ly * weight;
        self.u_yy += ring.u_yy * weight;
    }
}

/// Energy density of the ring at `sigma`; `shrink` is `1/l`.
fn ring_energy<D: Scalar>(material: &Material<D>, l: D, shrink: D, y: D, sigma: f64) -> SectionEnergy<D> {
    let hoop = (y - shrink * (1.0 - sigma)) / sigma;
    let m = material.response(l * l, hoop);
    // Derivatives of h2 = ln(hoop)/2; those of h1 = ln(l) are 1/l and -1/l^2.
    let half = (hoop * (2.0 * sigma)).recip();
    let h_l = shrink * shrink * (1.0 - sigma) * half;
    let h_y = half;
    let h_ll = -(h_l * (shrink + h_l) * 2.0);
    SectionEnergy {
        u: m.w,
        u_l: m.w1 * shrink + m.w2 * h_l,
        u_y: m.w2 * h_y,
        u_ll: (m.w11 - m.w1) * shrink * shrink + m.w12 * shrink * h_l * 2.0 + m.w22 * h_l * h_l + m.w2 * h_ll,
        u_ly: h_y * (m.w12 * shrink + (m.w22 - m.w2 * 2.0) * h_l),
        u_yy: (m.w22 - m.w2 * 2.0) * h_y * h_y,
    }
}

/// Points and weights on [-1, 1]: the zeros of the Legendre polynomial, by Newton's method.
fn gauss_legendre() -> [(f64, f64); POINTS] {
    std::array::from_fn(|i| {
        let guess = std::f64::consts::PI * (i as f64 + 0.75) / (POINTS as f64 + 0.5);
        let mut x = guess.cos();
        for _ in 0..20 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let (_, slope) = legendre(x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Legendre polynomial of degree `POINTS` and its slope.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=POINTS {
        let k = k as f64;
        let next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        (before, value) = (value, next);
    }
    let slope = POINTS as f64 * (x * value - before) / (x * x - 1.0);
    (value, slope)
}
