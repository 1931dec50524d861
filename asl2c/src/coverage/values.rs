//! Random values of the environment: mostly close to the numbers in the agent's text, because comparisons with those
//! decide what it does.

use rand::{Rng, RngExt as _};
use translator::configuration::Configuration;
use translator::interpreter::Value;
use translator::types::{CType, TypeKind};

use crate::run::{fields, numbers};

/// The numbers in an agent's text, also those in comments.
pub(super) struct Numbers {
    whole: Vec<i128>,
    real: Vec<f64>,
}

impl Numbers {
    pub(super) fn new(text: &str) -> Self {
        let mut words: Vec<&str> = numbers(text).chain(["0", "1"]).collect();
        words.sort_unstable();
        words.dedup();
        let real = words.iter().filter_map(|word| word.parse::<f64>().ok());
        Self {
            whole: words.iter().filter_map(|word| word.parse().ok()).collect(),
            real: real.filter(|number| number.is_finite()).collect(),
        }
    }

    /// Any value of a type; an empty text for those that cannot be created.
    pub(super) fn any(
        &self,
        ctype: &CType,
        configuration: &Configuration,
        random: &mut impl Rng,
    ) -> Value {
        match ctype.kind {
            TypeKind::Bool => Value::Bool(random.random()),
            _ if ctype.is_peer() => {
                // One more than there are.
                let peers = i128::try_from(configuration.peers.len()).unwrap_or(0);
                Value::Integer(random.random_range(0..=peers))
            }
            TypeKind::Signed { .. } | TypeKind::Unsigned { .. } => {
                Value::Integer(self.integer(ctype, random))
            }
            TypeKind::Float64 => Value::Float(self.number(random)),
            #[allow(clippy::cast_possible_truncation, reason = "rounded as the type wants it")]
            TypeKind::Float32 => Value::Float((self.number(random) as f32).into()),
            TypeKind::Struct => {
                let fields = fields(ctype, configuration);
                let values = fields.iter().map(|ctype| self.any(ctype, configuration, random));
                Value::Struct(values.collect())
            }
            TypeKind::Text => {
                let texts = ["", "a", "b, c"];
                Value::Text(texts[random.random_range(0..texts.len())].to_owned())
            }
            TypeKind::Opaque | TypeKind::Void => Value::Text(String::new()),
        }
    }

    fn integer(&self, ctype: &CType, random: &mut impl Rng) -> i128 {
        let (low, high) = ctype.integer_range().unwrap_or((0, 1));
        let value = match random.random_range(0..16) {
            0 => low,
            1 => high,
            2 => random.random_range(-3..100),
            3 => random.random_range(0..100_000),
            4 | 5 => {
                // Sums and differences of two of them are often limits, too.
                let difference = random.random_range(-1..=1) * self.one_of(random);
                self.one_of(random) + difference
            }
            _ => self.one_of(random) + random.random_range(-1..=1),
        };
        value.clamp(low, high)
    }

    /// A time that passes.
    pub(super) fn duration(&self, random: &mut impl Rng) -> i128 {
        if random.random_range(0..64) == 0 {
            // Until the clock overflows.
            return i128::MAX / 2;
        }
        (self.one_of(random) + random.random_range(-1..=1)).max(0)
    }

    fn one_of(&self, random: &mut impl Rng) -> i128 {
        // 0 and 1 are always among them.
        self.whole[random.random_range(0..self.whole.len())]
    }

    fn number(&self, random: &mut impl Rng) -> f64 {
        let own = self.real[random.random_range(0..self.real.len())];
        match random.random_range(0..32) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3..8 => f64::from(random.random_range(-800..800)) / 8.0,
            8..12 => -own,
            12..16 => own + f64::from(random.random_range(-8..=8)) / 8.0,
            16..20 => own.next_up(),
            20..24 => own.next_down(),
            _ => own,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn values_are_in_range_and_often_the_agents_own() {
        let numbers = Numbers::new("+!go : charge < 4711 & height > 2.5 <- act(300).");
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let configuration = Configuration::default();
        let mut any = |name: &str| numbers.any(&CType::named(name), &configuration, &mut random);
        let bytes: Vec<Value> = (0..500).map(|_| any("int8_t")).collect();
        assert!(bytes.iter().all(|value| matches!(value, Value::Integer(-128..=127))));
        let wide: Vec<Value> = (0..500).map(|_| any("int64_t")).collect();
        assert!(wide.contains(&Value::Integer(4711)) && wide.contains(&Value::Integer(4710)));
        let real: Vec<Value> = (0..500).map(|_| any("double")).collect();
        assert!(real.contains(&Value::Float(2.5)) && real.contains(&Value::Float(f64::INFINITY)));
    }
}
