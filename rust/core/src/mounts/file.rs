//! The entry of an engine file for a body and its mounts.

use serde::{Deserialize, Serialize};

use super::{
    DIRECTIONS, ForceTable, LoadCase, Mount, MountFigures, Powertrain, Products, Receiver,
    Receptance, RigidBody, Support, Table,
};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::is_default;
use crate::numbers::limits;

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct PowertrainEntry {
    body: BodyEntry,
    mounts: Vec<MountFigures>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    subframe: Option<Box<PowertrainEntry>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    receptance: Option<ReceptanceEntry>,
    /// What shakes the body besides an engine.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    forces: Vec<ForceTable>,
    /// The case at whose state of rest snubbers are taken for what moves.
    #[serde(default, skip_serializing_if = "is_default")]
    rest: LoadCase,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct ReceptanceEntry {
    coordinates: Vec<[String; 2]>,
    frequency: Vec<f64>,
    real: Vec<Vec<Vec<f64>>>,
    imaginary: Vec<Vec<Vec<f64>>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    receivers: Vec<ReceiverEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct ReceiverEntry {
    name: String,
    real: Vec<Vec<[f64; 3]>>,
    imaginary: Vec<Vec<[f64; 3]>>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct BodyEntry {
    mass: f64,
    cg: [f64; 3],
    inertia: [[f64; 3]; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    products: Option<String>,
}

/// Complex numbers as their parts.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TableEntry {
    frequency: Vec<f64>,
    real: Vec<[f64; 3]>,
    imaginary: Vec<[f64; 3]>,
}

impl Products {
    /// The convention of a name.
    pub fn named(name: &str) -> Result<Self> {
        match name {
            "tensor" => Ok(Self::Tensor),
            "positive-integrals" => Ok(Self::PositiveIntegrals),
            other => {
                let hint =
                    "give \"tensor\" for -∫xy dm off the diagonal, or \"positive-integrals\"";
                Err(Error::value("products", format!("{other:?}"), hint))
            }
        }
    }
}

impl PowertrainEntry {
    pub fn of(powertrain: &Powertrain) -> Self {
        let (subframe, receptance) = match powertrain.support() {
            None => (None, None),
            Some(Support::Subframe(subframe)) => (Some(Box::new(Self::of(subframe))), None),
            Some(Support::Receptance(receptance)) => (None, Some(ReceptanceEntry::of(receptance))),
        };
        let mounts = powertrain.mounts().iter().map(|mount| mount.figures().clone()).collect();
        let (body, forces) = (BodyEntry::of(powertrain.body()), powertrain.forces().to_vec());
        let rest = *powertrain.rest();
        Self { body, mounts, subframe, receptance, forces, rest }
    }

    /// The powertrain; `place` is its name in errors, and a point.
    pub fn powertrain(self, place: &str) -> Result<Powertrain> {
        let within = |part: &str| {
            let name = format!("{place}{part}");
            move |error: Error| error.within(&name)
        };
        let BodyEntry { mass, cg, inertia, products } = self.body;
        let products = products.map(|name| Products::named(&name)).transpose();
        let body = products.and_then(|products| RigidBody::new(mass, cg, inertia, products));
        let mounts = self.mounts.into_iter().enumerate();
        let mounts = mounts
            .map(|(k, figures)| Mount::new(figures).map_err(within(&format!("mounts[{k}]."))));
        let body = body.map_err(within("body."))?;
        let powertrain = Powertrain::resting(body, mounts.collect::<Result<_>>()?, self.rest)
            .map_err(within(""))?;
        let powertrain = powertrain.with_forces(self.forces).map_err(within(""))?;
        let support = match (self.subframe, self.receptance) {
            (None, None) => return Ok(powertrain),
            (Some(_), Some(_)) => {
                let hint = "is given beside a receptance: leave out one of them";
                return Err(Error::value(format!("{place}subframe"), "a table", hint));
            }
            (Some(subframe), None) => {
                let subframe = subframe.powertrain(&format!("{place}subframe."))?;
                Support::Subframe(Box::new(subframe))
            }
            (None, Some(receptance)) => {
                Support::Receptance(receptance.receptance().map_err(within("receptance."))?)
            }
        };
        powertrain.on(support).map_err(within(""))
    }
}

impl BodyEntry {
    fn of(body: &RigidBody) -> Self {
        let inertia = body.inertia();
        let has_products = inertia != nalgebra::Matrix3::from_diagonal(&inertia.diagonal());
        Self {
            mass: body.mass(),
            cg: body.cg().into(),
            inertia: [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[(i, j)])),
            products: has_products.then(|| "tensor".into()),
        }
    }
}

impl ReceptanceEntry {
    fn of(receptance: &Receptance) -> Self {
        let count = receptance.coordinates.len();
        let parts = |part: fn(&Complex64) -> f64| {
            let rows = |matrix: &Vec<Complex64>| {
                matrix.chunks(count).map(|row| row.iter().map(part).collect()).collect()
            };
            receptance.values.iter().map(rows).collect()
        };
        let receiver = |receiver: &Receiver| {
            let parts = |part: fn(&Complex64) -> f64| {
                let rows = |row: &Vec<[Complex64; 3]>| {
                    row.iter().map(|moved| moved.each_ref().map(part)).collect()
                };
                receiver.transfer.iter().map(rows).collect()
            };
            let name = receiver.name.clone();
            ReceiverEntry { name, real: parts(|h| h.re), imaginary: parts(|h| h.im) }
        };
        let coordinates = receptance.coordinates.iter();
        Self {
            coordinates: coordinates
                .map(|(name, axis)| [name.clone(), DIRECTIONS[*axis].into()])
                .collect(),
            frequency: receptance.frequency.clone(),
            real: parts(|h| h.re),
            imaginary: parts(|h| h.im),
            receivers: receptance.receivers.iter().map(receiver).collect(),
        }
    }

    fn receptance(self) -> Result<Receptance> {
        let coordinates = self.coordinates.into_iter().enumerate().map(|(k, [name, axis])| {
            let place = DIRECTIONS.iter().position(|direction| *direction == axis);
            place.map(|place| (name, place)).ok_or_else(|| {
                let hint = "give \"x\", \"y\" or \"z\"";
                Error::value(format!("coordinates[{k}][1]"), format!("{axis:?}"), hint)
            })
        });
        let coordinates = coordinates.collect::<Result<Vec<_>>>()?;
        let values = joined(&self.real, &self.imaginary, "real", |re, im| Complex64::new(*re, *im));
        let mut receivers = Vec::new();
        for (k, entry) in self.receivers.into_iter().enumerate() {
            let place = format!("receivers[{k}].real");
            let transfer = joined_rows(&entry.real, &entry.imaginary, &place, |re, im| {
                [0, 1, 2].map(|axis| Complex64::new(re[axis], im[axis]))
            })?;
            receivers.push(Receiver { name: entry.name, transfer });
        }
        Receptance { coordinates, frequency: self.frequency, values: values?, receivers }.checked()
    }
}

/// Real and imaginary parts of matrices as complex numbers, their rows one after the other.
fn joined<T, U>(
    real: &[Vec<Vec<T>>],
    imaginary: &[Vec<Vec<T>>],
    place: &str,
    join: impl Fn(&T, &T) -> U,
) -> Result<Vec<Vec<U>>> {
    let same = |found, expected| {
        limits::same_length("imaginary", found, place, expected, "frequency and coordinate")
    };
    same(imaginary.len(), real.len())?;
    let matrix = |(real, imaginary): (&Vec<Vec<T>>, &Vec<Vec<T>>)| {
        joined_rows(real, imaginary, place, &join).map(|rows| rows.into_iter().flatten().collect())
    };
    real.iter().zip(imaginary).map(matrix).collect()
}

/// Real and imaginary parts of rows as complex numbers.
fn joined_rows<T, U>(
    real: &[Vec<T>],
    imaginary: &[Vec<T>],
    place: &str,
    join: impl Fn(&T, &T) -> U,
) -> Result<Vec<Vec<U>>> {
    let same = |found, expected| {
        limits::same_length("imaginary", found, place, expected, "frequency and coordinate")
    };
    same(imaginary.len(), real.len())?;
    let row = |(real, imaginary): (&Vec<T>, &Vec<T>)| {
        same(imaginary.len(), real.len())?;
        Ok(real.iter().zip(imaginary).map(|(re, im)| join(re, im)).collect())
    };
    real.iter().zip(imaginary).map(row).collect()
}

impl From<Table> for TableEntry {
    fn from(Table { frequency, stiffness }: Table) -> Self {
        let parts = |part: fn(&Complex64) -> f64| {
            stiffness.iter().map(|along| along.each_ref().map(part)).collect()
        };
        Self { frequency, real: parts(|k| k.re), imaginary: parts(|k| k.im) }
    }
}

impl TryFrom<TableEntry> for Table {
    type Error = Error;

    fn try_from(TableEntry { frequency, real, imaginary }: TableEntry) -> Result<Self> {
        limits::same_length("imaginary", imaginary.len(), "real", real.len(), "frequency")?;
        let complex = |(re, im): ([f64; 3], [f64; 3])| {
            [0, 1, 2].map(|axis| Complex64::new(re[axis], im[axis]))
        };
        Ok(Self { frequency, stiffness: real.into_iter().zip(imaginary).map(complex).collect() })
    }
}
