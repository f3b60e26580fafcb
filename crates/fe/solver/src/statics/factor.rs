//! Cholesky factors of matrices that share a pattern: what depends on the pattern alone is done once.

use faer::{
    Conj, MatMut, Par, Side, Spec,
    dyn_stack::{MemBuffer, MemStack, StackReq},
    sparse::linalg::{
        SupernodalThreshold,
        cholesky::{
            CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
        },
    },
};

use super::matrix::Matrix;
use crate::error::Error;

/// One thread: the bits of a factorisation then do not depend on how many there are.
const PAR: Par = Par::Seq;

/// Right-hand sides that are solved at once, at most.
const COLUMNS: usize = 8;

/// A factor L of L Lᵀ, and the memory in which the next one is computed.
pub(super) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    scratch: MemBuffer,
}

impl Factor {
    /// Lays out the factor of matrices with this pattern, eliminated in the order in which they are numbered.
    /// Its numbers take over the memory of those of a factor that is done with: fresh memory costs as much as
    /// half a factorisation.
    pub(super) fn new(matrix: &Matrix, memory: Vec<f64>) -> Result<Self, Error> {
        // Without an ordering the symbolic analysis needs the upper triangle and the numeric one the lower.
        let upper = matrix.pattern().transpose().to_col_major().map_err(failed)?;
        let order = SymmetricOrdering::Identity;
        // By dense blocks, whatever the size: one column after the other takes longer on graded meshes, too.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(upper.as_ref(), Side::Upper, order, params).map_err(failed)?;
        let scratch = StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(PAR, Spec::default()),
            symbolic.solve_in_place_scratch::<f64>(COLUMNS, PAR),
        ]);
        let scratch = MemBuffer::try_new(scratch).map_err(failed)?;
        Ok(Self { symbolic, values: memory, scratch })
    }

    /// The memory of its numbers.
    pub(super) fn into_memory(self) -> Vec<f64> {
        self.values
    }

    /// Numbers of the factor.
    pub(super) fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    pub(super) fn compute(&mut self, matrix: &Matrix) -> Result<(), Error> {
        let missing = self.entries().saturating_sub(self.values.len());
        self.values.try_reserve_exact(missing).map_err(failed)?;
        self.values.resize(self.entries(), 0.0);
        let (stack, no) = (MemStack::new(&mut self.scratch), Default::default());
        self.symbolic
            .factorize_numeric_llt(
                &mut self.values,
                matrix.view(),
                Side::Lower,
                no,
                PAR,
                stack,
                Spec::default(),
            )
            .map_err(failed)?;
        Ok(())
    }

    /// Solves in place for right-hand sides of `n` numbers that follow one another: the factor is read once
    /// for several of them.
    pub(super) fn solve(&mut self, rhs: &mut [f64], n: usize) {
        for some in rhs.chunks_mut((COLUMNS * n).max(1)) {
            let columns = some.len() / n;
            let some = MatMut::from_column_major_slice_mut(some, n, columns);
            let stack = MemStack::new(&mut self.scratch);
            LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(Conj::No, some, PAR, stack);
        }
    }
}

fn failed(error: impl std::fmt::Debug) -> Error {
    Error::Factorisation(format!("{error:?}"))
}
