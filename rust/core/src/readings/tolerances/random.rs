//! Random numbers by counter: a number depends on the seed and on its place alone.
//!
//! Philox 4x64-10 (Salmon, Moraes, Dror, Shaw: Parallel random numbers: as easy as 1, 2, 3, SC'11)
//! encrypts a counter with the seed as its key. Any sample can be drawn by itself, by any thread and in
//! any order. The bits are those of `numpy.random.Philox(counter=[0, sample, stream, 0], key=seed)`.

/// Numbers that one counter makes.
pub(super) const BLOCK: usize = 4;

/// Four random words: block `block` of a sample's stream.
#[inline]
pub(super) fn words(seed: u64, stream: u64, sample: u64, block: u64) -> [u64; BLOCK] {
    // NumPy counts before it draws.
    philox([block + 1, sample, stream, 0], [seed, 0])
}

#[inline]
fn philox(mut counter: [u64; 4], mut key: [u64; 2]) -> [u64; 4] {
    const ROUNDS: usize = 10;
    const MULTIPLIERS: [u64; 2] = [0xD2E7_470E_E14C_6C93, 0xCA5A_8263_9512_1157];
    const WEYL: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xBB67_AE85_84CA_A73B];
    for _ in 0..ROUNDS {
        let a = u128::from(MULTIPLIERS[0]) * u128::from(counter[0]);
        let b = u128::from(MULTIPLIERS[1]) * u128::from(counter[2]);
        counter = [
            (b >> 64) as u64 ^ counter[1] ^ key[0],
            b as u64,
            (a >> 64) as u64 ^ counter[3] ^ key[1],
            a as u64,
        ];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// A number above 0 and below 1 from the upper 52 bits of a word; as many lie above 1/2 as below.
#[inline(always)]
pub(super) fn uniform(word: u64) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
    ((word >> 12) as f64 + 0.5) * STEP
}

/// Largest magnitude of a [`normals`], rounded up: the quantile of 2⁻⁵³ is −8.21.
pub(super) const LARGEST_NORMAL: f64 = 8.3;

/// Quantiles of the standard normal distribution, in place of probabilities.
///
/// Algorithm AS 241, PPND16 (Wichura, Applied Statistics 37, 1988, p. 477): within 1e-16 of them,
/// relatively.
#[inline(always)]
#[expect(clippy::excessive_precision, reason = "the coefficients as AS 241 gives them")]
pub(super) fn normals<const N: usize>(probabilities: &mut [f64; N]) {
    const CENTRAL: [[f64; 8]; 2] = [
        [
            3.387_132_872_796_366_608_0,
            1.331_416_678_917_843_774_5e2,
            1.971_590_950_306_551_442_7e3,
            1.373_169_376_550_946_112_5e4,
            4.592_195_393_154_987_145_7e4,
            6.726_577_092_700_870_085_3e4,
            3.343_057_558_358_812_810_5e4,
            2.509_080_928_730_122_672_7e3,
        ],
        [
            1.0,
            4.231_333_070_160_091_125_2e1,
            6.871_870_074_920_579_083_0e2,
            5.394_196_021_424_751_107_7e3,
            2.121_379_430_158_659_586_7e4,
            3.930_789_580_009_271_061_0e4,
            2.872_908_573_572_194_267_4e4,
            5.226_495_278_852_854_561_0e3,
        ],
    ];
    let given = *probabilities;
    // A loop without branches, of tails too, which then are replaced.
    for (probability, p) in probabilities.iter_mut().zip(given) {
        let q = p - 0.5;
        let r = 0.180_625 - q * q;
        *probability = q * horner(&CENTRAL[0], r) / horner(&CENTRAL[1], r);
    }
    for (probability, p) in probabilities.iter_mut().zip(given) {
        if (p - 0.5).abs() > 0.425 {
            *probability = tail(p);
        }
    }
}

/// The quantile of a probability below 0.075, or above 0.925.
#[expect(clippy::excessive_precision, reason = "the coefficients as AS 241 gives them")]
fn tail(p: f64) -> f64 {
    const NEAR: [[f64; 8]; 2] = [
        [
            1.423_437_110_749_683_577_34,
            4.630_337_846_156_545_295_90,
            5.769_497_221_460_691_405_50,
            3.647_848_324_763_204_605_04,
            1.270_458_252_452_368_382_58,
            2.417_807_251_774_506_117_70e-1,
            2.272_384_498_926_918_458_33e-2,
            7.745_450_142_783_414_076_40e-4,
        ],
        [
            1.0,
            2.053_191_626_637_758_821_87,
            1.676_384_830_183_803_849_40,
            6.897_673_349_851_000_045_50e-1,
            1.481_039_764_274_800_745_90e-1,
            1.519_866_656_361_645_719_66e-2,
            5.475_938_084_995_344_946_00e-4,
            1.050_750_071_644_416_843_24e-9,
        ],
    ];
    const FAR: [[f64; 8]; 2] = [
        [
            6.657_904_643_501_103_777_20,
            5.463_784_911_164_114_369_90,
            1.784_826_539_917_291_335_80,
            2.965_605_718_285_048_912_30e-1,
            2.653_218_952_657_612_309_30e-2,
            1.242_660_947_388_078_438_60e-3,
            2.711_555_568_743_487_578_15e-5,
            2.010_334_399_292_288_132_65e-7,
        ],
        [
            1.0,
            5.998_322_065_558_879_376_90e-1,
            1.369_298_809_227_358_053_10e-1,
            1.487_536_129_085_061_485_25e-2,
            7.868_691_311_456_132_591_00e-4,
            1.846_318_317_510_054_681_80e-5,
            1.421_511_758_316_445_888_70e-7,
            2.044_263_103_389_939_785_64e-15,
        ],
    ];
    let r = (-p.min(1.0 - p).ln()).sqrt();
    let (coefficients, r) = if r <= 5.0 { (NEAR, r - 1.6) } else { (FAR, r - 5.0) };
    (horner(&coefficients[0], r) / horner(&coefficients[1], r)).copysign(p - 0.5)
}

#[inline(always)]
fn horner(coefficients: &[f64; 8], x: f64) -> f64 {
    let mut sum = coefficients[7];
    for k in (0..7).rev() {
        sum = sum * x + coefficients[k];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_the_paper() {
        // Known answers of Random123 1.09, philox4x64 with 10 rounds.
        assert_eq!(
            philox([0; 4], [0; 2]),
            [
                0x1655_4D9E_CA36_314C,
                0xDB20_FE9D_672D_0FDC,
                0xD7E7_72CE_E186_176B,
                0x7E68_B68A_EC7B_A23B
            ]
        );
        assert_eq!(
            philox([u64::MAX; 4], [u64::MAX; 2]),
            [
                0x87B0_92C3_013F_E90B,
                0x438C_3C67_BE8D_0224,
                0x9CC7_D7C6_9CD7_77B6,
                0xA09C_AEBF_594F_0BA0
            ]
        );
    }

    #[test]
    fn uniforms_lie_between_the_ends() {
        assert_eq!(uniform(0), 0.5 * f64::EPSILON);
        assert_eq!(uniform(u64::MAX), 1.0 - 0.5 * f64::EPSILON);
        assert_eq!(uniform(1 << 63) - 0.5, 0.5 - uniform((1 << 63) - 1));
    }

    #[test]
    fn quantiles_are_those_of_the_normal_distribution() {
        // From 50 digits; the first two are those of AS 241.
        let known = [
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_813_5),
            (1e-20_f64, -9.262_340_089_798_408),
            (0.5, 0.0),
            (0.93, 1.475_791_028_179_171),
            (0.5 * f64::EPSILON, -8.209_536_151_601_387),
        ];
        for (probability, quantile) in known {
            let mut found = [probability];
            normals(&mut found);
            let apart = (found[0] - quantile).abs();
            assert!(apart <= 4.0 * f64::EPSILON * quantile.abs(), "{probability}: {}", found[0]);
        }
        let mut ends = [uniform(0), uniform(u64::MAX)];
        normals(&mut ends);
        assert!(ends.iter().all(|end| (8.0..LARGEST_NORMAL).contains(&end.abs())));
        assert_eq!(ends[0], -ends[1]);
    }
}
