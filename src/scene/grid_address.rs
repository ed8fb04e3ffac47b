//! How scenes address the grids of a file: by name, and from the second of one name on by
//! `name[n]`, counted from 0 as OpenVDB does.

/// Index of the grid that `address` means among grids of these `names`. `name[n]` is the n-th of
/// that name; where there is none, the whole text is a name.
pub(super) fn find<'a>(
    names: impl Iterator<Item = &'a str> + Clone,
    address: &str,
) -> Option<usize> {
    let nth = |name: &str, n: usize| {
        names.clone().enumerate().filter(|(_, other)| *other == name).map(|(index, _)| index).nth(n)
    };
    split(address).and_then(|(name, n)| nth(name, n)).or_else(|| nth(address, 0))
}

/// The shortest address of the grid at `index`, which [`find`] leads back to it.
pub(super) fn of<'a>(names: impl Iterator<Item = &'a str> + Clone, index: usize) -> String {
    let name = names.clone().nth(index).unwrap_or_default();
    if find(names.clone(), name) == Some(index) {
        return name.to_owned();
    }
    let earlier = names.take(index).filter(|other| *other == name).count();
    format!("{name}[{earlier}]")
}

/// Whether two addresses mean one grid: the first of a name needs no number.
pub(super) fn is_same(a: &str, b: &str) -> bool {
    a.strip_suffix("[0]").unwrap_or(a) == b.strip_suffix("[0]").unwrap_or(b)
}

/// The parts of `name[n]`.
fn split(address: &str) -> Option<(&str, usize)> {
    let (name, number) = address.strip_suffix(']')?.rsplit_once('[')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    Some((name, number.parse().ok().filter(|_| is_number)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grid_has_an_address_that_leads_back_to_it() {
        let names = ["density", "", "density", "density[1]", "", "density[1]", "vel[x]", "a[0]"];
        let addresses: Vec<String> =
            (0..names.len()).map(|index| of(names.into_iter(), index)).collect();
        let expected = [
            "density",
            "",
            "density[1]",
            "density[1][0]",
            "[1]",
            "density[1][1]",
            "vel[x]",
            "a[0]",
        ];
        assert_eq!(addresses, expected);
        for (index, address) in addresses.iter().enumerate() {
            assert_eq!(find(names.into_iter(), address), Some(index), "{address}");
        }
        assert_eq!(find(names.into_iter(), "density[0]"), Some(0));
        for absent in ["density[2]", "density[-1]", "density[+1]", "density[]", "Density", "vel"] {
            assert_eq!(find(names.into_iter(), absent), None, "{absent}");
        }
        assert_eq!(find(names.into_iter(), "density[99999999999999999999999]"), None);
    }

    #[test]
    fn the_first_of_a_name_needs_no_number() {
        assert!(is_same("density", "density[0]") && is_same("density[1]", "density[1]"));
        assert!(!is_same("density", "density[1]") && !is_same("density", "densit"));
    }
}
