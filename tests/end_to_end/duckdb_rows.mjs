// The rows of a query, as JSON: duckdb_rows.mjs FOLDER_OF_PACKAGE SQL
import { createRequire } from 'node:module';

const [, , folder, sql] = process.argv;
const { DuckDBInstance } = createRequire(folder + '/')('@duckdb/node-api');
const instance = await DuckDBInstance.create(':memory:');
const connection = await instance.connect();
const answer = await connection.runAndReadAll(sql);
console.log(JSON.stringify(answer.getRowObjectsJson()));
